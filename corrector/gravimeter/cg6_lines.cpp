#include <fmt/core.h>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kCg6Title = "CG-6 Survey";

/// Place of the tide among the digits of the corrections that the value contains: drift,
/// temperature, unused, tide, tilt.
constexpr std::size_t kTideFlag = 3;

/// The reader of a file with one or more surveys.
class Cg6Lines : public LineReader {
public:
    Line read(std::string_view line) override {
        if (trimmed(line).empty()) return Comment{};
        const bool is_header = line.front() == '/';
        if (is_header) line = trimmed(line.substr(1));
        // A program that copies readings can leave out the sign of a header before the names.
        if (line.starts_with("Station\t")) {
            layout_ = named_layout(Form::cg6, split_at(line, '\t'));
            if (!layout_.trouble.empty()) return Refusal{layout_.trouble};
            return Comment{};
        }
        return is_header ? header_line(line) : reading_line(line);
    }

    [[nodiscard]] std::string layout() const override { return layout_.description; }

private:
    Line header_line(std::string_view line) {
        if (line == kCg6Title) {
            instrument_.clear();
            layout_ = {};
        }
        constexpr std::string_view kSerial = "Instrument Serial Number:";
        if (line.starts_with(kSerial)) {
            const std::string_view serial = trimmed(line.substr(kSerial.size()));
            if (!text::trouble_with_site_name(serial).empty())
                return Refusal{"Instrument Serial Number: not as a CG-6 writes it"};
            instrument_ = fmt::format("CG-6 {}", serial);
        }
        return Comment{};
    }

    [[nodiscard]] Line reading_line(std::string_view line) const {
        if (instrument_.empty() || layout_.places.empty())
            return Refusal{"no header with serial number and names of columns before it"};
        if (!layout_.trouble.empty()) return Refusal{"its columns are not known"};
        Fields fields(layout_, split_at(line, '\t'));
        const UtcTime time = fields.time();
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        Reading reading = fields.reading();
        reading.instrument = instrument_;
        reading.time = time;
        if (fields.text("applied")[kTideFlag] != '1') reading.tide_correction.reset();
        return reading;
    }

    std::string instrument_;
    Layout layout_;
};

}  // namespace

Format cg6_format() {
    return {"Scintrex CG-6", "of the instrument",
            [](std::string_view line) {
                return line.starts_with('/') && trimmed(line.substr(1)) == kCg6Title;
            },
            [](const ReadOptions&) -> std::unique_ptr<LineReader> {
                return std::make_unique<Cg6Lines>();
            }};
}

}  // namespace a351::corrector::gravimeter
