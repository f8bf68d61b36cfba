#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/predicate.hpp>
#include <set>
#include <string>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/csv_reader.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Columns of the older programs: those of the Android program up to the longitude, and one less
/// if the observer is missing.
constexpr std::size_t kWithoutNames = 16;

/// Remedy where a blank in a name can have moved the columns.
constexpr std::string_view kNoBlanks =
    "names without blanks, or commas or tabs between the columns";

Layout layout_without_names(std::size_t width) {
    auto names = usual_names(Form::burris);
    if (width < names.size()) names.resize(kWithoutNames);
    if (width < kWithoutNames) names.erase(names.begin() + 1);
    return usual_layout(Form::burris, names);
}

/// Returns the usual layout of lines with so many columns; without places if there is none.  A note
/// can have separators in it.
const Layout& layout_of_width(std::size_t width) {
    static const Layout none, oldest = layout_without_names(15), old = layout_without_names(16),
                              android = layout_without_names(20);
    for (const Layout* const layout : {&oldest, &old})
        if (width == layout->places.size()) return *layout;
    return width >= android.places.size() ? android : none;
}

/// Joins the parts of a cell in quotation marks that has separators in it.
void join_quoted(std::vector<std::string_view>& cells) {
    for (auto first = cells.begin(); first != cells.end(); ++first) {
        if (!first->starts_with('"') || (first->size() > 1 && first->ends_with('"'))) continue;
        const auto last = std::find_if(first + 1, cells.end(),
                                       [](std::string_view cell) { return cell.ends_with('"'); });
        if (last == cells.end()) return;
        *first = std::string_view(first->data(), last->data() + last->size());
        cells.erase(first + 1, last + 1);
    }
}

std::vector<std::string_view> split(std::string_view line) {
    auto cells = split_at_blanks(line);
    for (const char separator : {',', '\t'})
        if (line.find(separator) != std::string_view::npos) cells = split_at(line, separator);
    // A spreadsheet can have quoted the texts.
    join_quoted(cells);
    for (std::string_view& cell : cells)
        if (cell.size() > 2 && cell.front() == '"' && cell.back() == '"')
            cell = cell.substr(1, cell.size() - 2);
    return cells;
}

bool is_between_blanks(std::string_view line) {
    return line.find_first_of(",\t") == std::string_view::npos;
}

/// Returns true for a line of names, also with some that nobody knows or in other capitals.
bool is_names(const std::vector<std::string_view>& cells) {
    constexpr std::array<std::string_view, 5> kSeveral{"Serial Number", "Date", "Time", "ObsG",
                                                       "Dial"};
    return std::ranges::count_if(kSeveral, [&](std::string_view name) {
               return std::ranges::any_of(cells, [&](std::string_view cell) {
                   return boost::algorithm::iequals(cell, name);
               });
           }) >= 3;
}

/// Joins the cells of a note that has separators in it.
void join_note(std::vector<std::string_view>& cells, std::string_view line, const Layout& layout) {
    const std::size_t last = layout.places.size() - 1;
    if (cells.size() <= last + 1 || layout.places[last].column->field != "note") return;
    cells[last] = line.substr(static_cast<std::size_t>(cells[last].data() - line.data()));
    cells.resize(last + 1);
}

bool is_reading(std::vector<std::string_view> cells, std::string_view line) {
    const Layout& layout = layout_of_width(cells.size());
    if (layout.places.empty()) return false;
    join_note(cells, line, layout);
    Fields fields(layout, cells);
    (void)fields.time({}, true);
    return fields.trouble().empty();
}

/// Returns true for a line that has the usual columns of a reading, also one with further words in the
/// names of station and observer.
bool is_reading(std::string_view line) {
    auto cells = split(line);
    if (is_reading(cells, line)) return true;
    if (cells.size() <= kWithoutNames || !is_between_blanks(line)) return false;
    cells.erase(cells.begin() + 1, cells.end() - (kWithoutNames - 2));
    return is_reading(cells, line);
}

/// Returns true if the dates of a file with the year last prove that the month is first: the second
/// number exceeds 12 somewhere and the first one nowhere.
bool is_month_first(std::string_view text) {
    bool is_proven = false;
    for (const std::string_view line : split_at(text, '\n')) {
        for (const std::string_view cell : split(line)) {
            const auto day = parse_day(cell);
            if (!day || !day->has_year_last) continue;
            const auto parts = split_at(day->iso, '-');
            constexpr std::string_view kMonths = "12";
            if (parts[1] > kMonths) return false;
            is_proven = is_proven || parts[2] > kMonths;
        }
    }
    return is_proven;
}

class BurrisLines : public LineReader {
public:
    void look_at(std::string_view text) override { is_month_first_ = is_month_first(text); }

    Line read(std::string_view line) override {
        line = trimmed(line);
        if (line.empty()) return Comment{};
        auto cells = split(line);
        if (is_names(cells)) {
            layout_ = named_layout(Form::burris, cells);
            if (!layout_.trouble.empty()) return Refusal{layout_.trouble};
            return Comment{};
        }
        if (!layout_.trouble.empty()) return Refusal{"its columns are not known"};
        // Without names the first line that can be read decides, and the others must be like it.
        const Layout layout = layout_.places.empty() ? layout_of_width(cells.size()) : layout_;
        if (layout.places.empty())
            return Refusal{
                fmt::format("{} columns; allowed: 15, 16 or 20, and {}", cells.size(), kNoBlanks)};
        join_note(cells, line, layout);
        Fields fields(layout, cells);
        const UtcTime time = fields.time({}, is_month_first_);
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        if (const auto observer = fields.text("observer");
            !observer.empty() && is_between_blanks(line)) {
            if (text::parse_number(observer))
                return Refusal{
                    fmt::format("Observer ID = {}: a number, which can be the second word of the "
                                "station; allowed: {}",
                                observer, kNoBlanks)};
            observers_.emplace(observer);
        }
        layout_ = layout;
        has_year_last_ = has_year_last_ || parse_day(fields.text("date"))->has_year_last;
        Reading reading = fields.reading();
        reading.time = time;
        return reading;
    }

    [[nodiscard]] std::string layout() const override {
        return layout_.description + (has_year_last_ ? ", dates read as month/day/year" : "");
    }

    /// An observer between blanks can be the second word of a station.
    [[nodiscard]] std::string remark() const override {
        return observers_.size() < 2 ? ""
                                     : fmt::format("observers, if not second words of stations: {}",
                                                   fmt::join(observers_, ", "));
    }

private:
    Layout layout_;
    std::set<std::string> observers_;  ///< Between blanks.
    bool is_month_first_ = false;      ///< In dates with the year last.
    bool has_year_last_ = false;       ///< In a reading.
};

}  // namespace

Format burris_format() {
    return {"ZLS Burris", "15, 16 or 20 columns",
            [](std::string_view line) {
                return !trimmed(line).empty() &&
                       (is_names(split(trimmed(line))) || is_reading(trimmed(line)));
            },
            [](const ReadOptions&) -> std::unique_ptr<LineReader> {
                return std::make_unique<BurrisLines>();
            }};
}

}  // namespace a351::corrector::gravimeter
