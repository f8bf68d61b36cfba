#pragma once
/// @file
/// The columns of all gravimeters in one table: the name by each maker, and the field.
///
///     const Layout layout = named_layout(Form::cg6, split_at(names, '\t'));
///     if (!layout.trouble.empty()) return Refusal{layout.trouble};
///     const Fields fields(layout, split_at(line, '\t'));  // fields.hpp
///
/// A column of a new maker is a name in the table; a form with a line of names is an entry in
/// named_lines.cpp.

#include <string>
#include <string_view>
#include <vector>

namespace a351::corrector::gravimeter {

/// Forms of files, each with its own names of columns.
enum class Form { cg5, cg6, cg6_tsoft, cg6_lynx, burris, gcym };

/// Kind of a cell.
enum class CellType { text, site, instrument, number, date, time, flags };

/// Name of a column in one form.
struct ColumnName {
    Form form;
    std::string_view name;
    double factor = 1.0;  ///< Unit of the cell over the unit of the field: 0.01 for cm.
};

/// One column.  readings.csv has the kept ones under the names of their fields.
struct Column {
    std::string_view field;  ///< The field that it fills, with its unit.
    CellType type = CellType::text;
    double low = 0.0, high = 0.0;  ///< Limits of a number, in the unit of the field.
    bool is_required = false;      ///< A form that has a name for it cannot be without it.
    bool is_kept = false;          ///< readings.csv has it although nothing is computed from it.
    std::vector<ColumnName> names;
};

/// Returns the table, in the order in which readings.csv has the kept columns.
[[nodiscard]] const std::vector<Column>& columns();

/// The columns of a line, in its order.
struct Layout {
    struct Place {
        std::string name;  ///< Name that the maker gives it; messages have it.
        const Column* column = nullptr;
        double factor = 1.0;
    };
    std::vector<Place> places;
    std::string trouble;      ///< Why these columns cannot be read; empty if they can.
    std::string description;  ///< For people.
};

/// Returns the layout of a line of names.  Its trouble lists unknown, repeated and missing columns.
/// @param absent  fields that this file has elsewhere, and are not missing.
[[nodiscard]] Layout named_layout(Form form, const std::vector<std::string_view>& names,
                                  const std::vector<std::string_view>& absent = {});

/// Returns the names of a form in its usual order; empty if it has none.
[[nodiscard]] std::vector<std::string_view> usual_names(Form form);

/// Returns the layout of a file without names, which has these in its usual order.
[[nodiscard]] Layout usual_layout(Form form, const std::vector<std::string_view>& names,
                                  const std::vector<std::string_view>& absent = {});

}  // namespace a351::corrector::gravimeter
