#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "corrector/gravimeter/site_names.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kTitle = "CG-6 Gravity Survey", kVersion = "Software Version:";

/// Returns the instant of the columns Year to MilliSec.
std::optional<UtcTime> time_of(const Fields& fields) {
    const auto part = [&](std::string_view field) {
        return static_cast<int>(std::lround(fields.number(field).value_or(0.0)));
    };
    return parse_rfc3339(fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", part("year"),
                                     part("month"), part("day"), part("hour"), part("minute"),
                                     part("second"), part("millisecond")));
}

/// The reader of what the program Lynx LG writes: its own file, where each line has a station, and
/// the export for Tsoft, where the header has it.
class Cg6ExportLines : public LineReader {
public:
    Line read(std::string_view line) override {
        line = trimmed(line);
        if (line.empty()) return Comment{};
        if (line.front() == '/') return header_line(trimmed(line.substr(1)));
        is_in_names_ = false;
        if (layout_.places.empty()) choose_layout();
        return reading_line(line);
    }

    [[nodiscard]] std::string layout() const override {
        return fmt::format("{} {}{}", is_lynx_ ? "Lynx LG," : "export for Tsoft,",
                           layout_.description, has_notes_ ? ", with notes" : "");
    }

private:
    Line header_line(std::string_view line) {
        if (line == kTitle) *this = Cg6ExportLines();
        if (is_in_names_ && !line.empty()) {
            names_.emplace_back(line);
            return Comment{};
        }
        is_in_names_ = line == "Column Headers:";
        if (is_in_names_) {
            layout_ = {};
            names_.clear();
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) return Comment{};
        const std::string_view key = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
        bool is_valid = true;
        if (key == "Meter") {
            is_valid = text::trouble_with_site_name(value).empty();
            instrument_ = is_valid ? fmt::format("CG-6 {}", value) : "";
        }
        if (key == "Tidal Correction") {
            is_valid = value == "Enabled" || value == "Disabled";
            has_tide_ = is_valid ? std::optional(value == "Enabled") : std::nullopt;
        }
        if (key == "Station") site_ = value;
        if (key == "Occupation") stay_number_ = value;
        if (key == "Notes") {
            note_ = value;
            has_notes_ = has_notes_ || !value.empty();
        }
        if (!is_valid) return Refusal{fmt::format("{}: not as Lynx LG writes it", key)};
        return Comment{};
    }

    void choose_layout() {
        const std::vector<std::string_view> names(names_.begin(), names_.end());
        const auto usual = usual_names(Form::cg6_lynx);
        is_lynx_ = names.empty() || std::ranges::find(names, "Station") != names.end();
        if (!is_lynx_) {
            layout_ = named_layout(Form::cg6_tsoft, names);
        } else if (names.empty()) {
            layout_ = usual_layout(Form::cg6_lynx, usual);
        } else if (layout_ = named_layout(Form::cg6_lynx, names);
                   !layout_.trouble.empty() && is_in_usual_order(names, usual)) {
            // Its names are not published: those of what is computed vouch for the others.
            layout_ = usual_layout(Form::cg6_lynx, usual);
            layout_.description = fmt::format("{} columns, by their order", names.size());
        }
    }

    static bool is_in_usual_order(const std::vector<std::string_view>& names,
                                  const std::vector<std::string_view>& usual) {
        if (names.size() != usual.size()) return false;
        const auto places = usual_layout(Form::cg6_lynx, usual).places;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] != usual[i] && (places[i].column->is_required ||
                                         std::ranges::find(usual, names[i]) != usual.end()))
                return false;
        return true;
    }

    /// Returns the cells.  Those of a Lynx LG are between single blanks from Survey to Line, where
    /// each can be empty; the cells before and after these four are padded numbers.
    [[nodiscard]] std::vector<std::string_view> split(std::string_view line) const {
        auto cells = split_at_blanks(line);
        const auto& places = layout_.places;
        const auto first = std::ranges::find(places, "Survey", &Layout::Place::name);
        constexpr std::ptrdiff_t kNames = 4;
        const auto before = first - places.begin(), after = places.end() - first - kNames;
        if (!is_lynx_ || before < 1 || after < 1 || std::ssize(cells) < before + after)
            return cells;
        const std::string_view last_before = *(cells.begin() + before - 1);
        const char* const begin = last_before.data() + last_before.size() + 1;
        const char* const end = (cells.end() - after)->data() - 1;
        const auto names = end < begin ? std::vector<std::string_view>()
                                       : split_at(std::string_view(begin, end), ' ');
        cells.erase(cells.begin() + before, cells.end() - after);
        cells.insert(cells.begin() + before, names.begin(), names.end());
        return cells;
    }

    [[nodiscard]] Line reading_line(std::string_view line) const {
        if (!layout_.trouble.empty()) return Refusal{layout_.trouble};
        if (instrument_.empty() || !has_tide_)
            return Refusal{"no header with Meter and Tidal Correction before it"};
        const auto cells = split(line);
        if (is_lynx_ && cells.size() != layout_.places.size())
            return Refusal{fmt::format(
                "{} columns; allowed: {}, between single blanks from Survey to Line, so that no "
                "name has a blank in it",
                cells.size(), layout_.places.size())};
        const Fields fields(layout_, cells);
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        const auto time = time_of(fields);
        if (!time) return Refusal{"Year to MilliSec: not an instant"};
        Reading reading = fields.reading();
        reading.instrument = instrument_;
        reading.time = *time;
        if (!*has_tide_) reading.tide_correction.reset();
        if (!is_lynx_) {
            reading.site = site_;
            if (const auto trouble = text::trouble_with_site_name(table_name(site_));
                !trouble.empty())
                return Refusal{fmt::format("Station in the header: {}", trouble)};
            reading.kept.emplace_back("stay_number", stay_number_);
        }
        if (has_notes_) reading.kept.emplace_back("note", note_);
        return reading;
    }

    std::string instrument_, site_, stay_number_, note_;
    std::optional<bool> has_tide_;
    std::vector<std::string> names_;
    bool is_in_names_ = false, is_lynx_ = false, has_notes_ = false;
    Layout layout_;
};

}  // namespace

Format cg6_export_format() {
    return {"Scintrex CG-6", "of Lynx LG, with or without notes, or its export for Tsoft",
            [](std::string_view line) {
                if (!line.starts_with('/')) return false;
                line = trimmed(line.substr(1));
                return line == kTitle || line.starts_with(kVersion);
            },
            [](const ReadOptions&) -> std::unique_ptr<LineReader> {
                return std::make_unique<Cg6ExportLines>();
            }};
}

}  // namespace a351::corrector::gravimeter
