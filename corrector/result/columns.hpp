#pragma once
/// @file
/// The columns of occupations.csv, stations.csv, differences.csv and models.csv, in their order.
/// result.json has the same rows with the same keys.  table-format.md explains each column.
///
///     const auto columns = occupation_columns(result);
///     const std::string csv = csv_table(columns, result.rows);  // without result.left_out
///     const auto few = with_keys(columns, {"site", "corrected_mgal"});
///
/// Keys end with their unit: _mgal, _degc, _degc_per_h, _g, _s.  Refer to a column by its key: the
/// order may change, and further columns may be added.

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/column.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/catalogue.hpp"

namespace a351::corrector::result {

/// Returns the minutes that a reading averages: those between its limits, for `day` those of the
/// undisturbed samples; nothing for a table of averages.
[[nodiscard]] std::optional<double> used_minutes(const model::CorrectedRow& row);

/// Returns the columns of occupations.csv.  An occupation without a value has only the first seven,
/// from the site to the flags, and the last two, its grade.  Rows from records and rows of the whole-day model have more
/// columns.
///
/// The first row of the result decides which columns there are (columns_test.cpp).  All rows must
/// therefore be of one kind, as correct_survey() gives them.  Cells of other models are empty.
/// @param result  must outlive the columns and have at least one row.
[[nodiscard]] std::vector<Column<model::CorrectedRow>> occupation_columns(
    const model::SurveyCorrection& result);

/// Contributions to the u of the whole-day model: key of the column and heading, in the order of
/// whole_day::ErrorSource.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, whole_day::kErrorSources>
    kContributions{{{"u_placement_mgal", text::marked("Placement")},
                    {"u_flicker_mgal", text::marked("Flicker")},
                    {"u_white_mgal", text::marked("White")},
                    {"u_levelling_mgal", text::marked("Levelling")},
                    {"u_thermal_mgal", text::marked("Thermal")},
                    {"u_drift_mgal", text::marked("Drift")},
                    {"u_datum_mgal", text::marked("Datum")},
                    {"u_scale_mgal", text::marked("Scale")}}};

/// Appends the columns of kContributions.
/// @param parts_of  returns a pointer to the contributions of a row, mGal; null if there are none.
template <class Row, class PartsOf>
void append_contributions(std::vector<Column<Row>>& columns, PartsOf parts_of) {
    for (std::size_t k = 0; k < kContributions.size(); ++k)
        columns.push_back({kContributions.at(k).first,
                           [k, parts_of](const Row& row) {
                               const auto* const parts_mgal = parts_of(row);
                               return parts_mgal != nullptr ? cell(parts_mgal->at(k)) : Cell();
                           },
                           {kContributions.at(k).second, 2}});
}

/// Returns the columns of stations.csv.  They are the same for every model; cells that a model does
/// not give are empty.  The columns of anomalies are present if a station has anomalies.
[[nodiscard]] std::vector<Column<model::StationValue>> station_columns(
    const std::vector<model::StationValue>& stations);

/// Returns the columns of differences.csv.
[[nodiscard]] std::vector<Column<model::StationDifference>> difference_columns();

/// Returns the columns of models.csv, for the rows of score_rows().  The pointers in a row must not
/// be null.
/// @param result  must outlive the columns.
[[nodiscard]] std::vector<Column<ScoreRow>> score_columns(const model::SurveyCorrection& result);

}  // namespace a351::corrector::result
