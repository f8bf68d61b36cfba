#include <fmt/core.h>

#include <array>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// A form of files with headers, a line of names, and one reading in each line after it.
struct NamedForm {
    Form form;                         ///< Its names are in columns.cpp.
    std::string_view name, forms;      ///< Make, and forms that are read, for people.
    char header_sign = '/';            ///< First letter of a header.
    char separator = '\t';             ///< Between columns.
    std::string_view title;            ///< First header of a file and of each survey in it.
    std::string_view first_name;       ///< The line of names begins with it.
    std::string_view serial_number;    ///< Key of the header that has it; empty: a column has it.
    std::string_view instrument = {};  ///< Type, in front of the serial number.
};

/// A new maker is an entry here, and its names in the table of columns.
constexpr std::array kNamedForms{NamedForm{.form = Form::cg6,
                                           .name = "Scintrex CG-6",
                                           .forms = "of the instrument",
                                           .title = "CG-6 Survey",
                                           .first_name = "Station",
                                           .serial_number = "Instrument Serial Number:",
                                           .instrument = "CG-6"}};

/// Place of the tide among the digits of the corrections that a value contains: drift, temperature,
/// unused, tide, tilt.
constexpr std::size_t kTideFlag = 3;

/// The reader of a file with one or more surveys.
class NamedLines : public LineReader {
public:
    explicit NamedLines(const NamedForm& form) : form_(form) {}

    Line read(std::string_view line) override {
        if (trimmed(line).empty()) return Comment{};
        const bool is_header = line.front() == form_.header_sign;
        if (is_header) line = trimmed(line.substr(1));
        // A program that copies readings can leave out the sign of a header before the names.
        if (const auto cells = split_at(line, form_.separator);
            cells.size() > 1 && cells.front() == form_.first_name) {
            layout_ = named_layout(form_.form, cells);
            if (!layout_.trouble.empty()) return Refusal{layout_.trouble};
            return Comment{};
        }
        return is_header ? header_line(line) : reading_line(line);
    }

    [[nodiscard]] std::string layout() const override { return layout_.description; }

private:
    Line header_line(std::string_view line) {
        if (line == form_.title) {
            instrument_.clear();
            layout_ = {};
        }
        if (!form_.serial_number.empty() && line.starts_with(form_.serial_number)) {
            const std::string_view number = trimmed(line.substr(form_.serial_number.size()));
            if (!text::trouble_with_site_name(number).empty())
                return Refusal{
                    fmt::format("{} not as a {} writes it", form_.serial_number, form_.instrument)};
            instrument_ = fmt::format("{} {}", form_.instrument, number);
        }
        return Comment{};
    }

    [[nodiscard]] Line reading_line(std::string_view line) const {
        if (layout_.places.empty()) return Refusal{"no names of columns before it"};
        if (instrument_.empty() && !form_.serial_number.empty())
            return Refusal{"no header with the serial number before it"};
        if (!layout_.trouble.empty()) return Refusal{"its columns are not known"};
        Fields fields(layout_, split_at(line, form_.separator));
        const UtcTime time = fields.time();
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        Reading reading = fields.reading();
        if (!instrument_.empty()) reading.instrument = instrument_;
        reading.time = time;
        if (const auto applied = fields.text("applied");
            !applied.empty() && applied[kTideFlag] != '1')
            reading.tide_correction.reset();
        return reading;
    }

    const NamedForm& form_;
    std::string instrument_;
    Layout layout_;
};

}  // namespace

std::vector<Format> named_formats() {
    std::vector<Format> formats;
    for (const NamedForm& form : kNamedForms)
        formats.push_back({form.name, form.forms,
                           [&form](std::string_view line) {
                               return line.starts_with(form.header_sign) &&
                                      trimmed(line.substr(1)) == form.title;
                           },
                           [&form](const ReadOptions&) -> std::unique_ptr<LineReader> {
                               return std::make_unique<NamedLines>(form);
                           }});
    return formats;
}

}  // namespace a351::corrector::gravimeter
