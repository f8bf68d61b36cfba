#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Columns of the older programs: those of the Android program up to the longitude, and one less
/// if the observer is missing.
constexpr std::size_t kWithoutNames = 16;

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

std::vector<std::string_view> split(std::string_view line) {
    auto cells = split_at_blanks(line);
    for (const char separator : {',', '\t'})
        if (line.find(separator) != std::string_view::npos) cells = split_at(line, separator);
    // A spreadsheet can have quoted the texts.
    for (std::string_view& cell : cells)
        if (cell.size() > 2 && cell.front() == '"' && cell.back() == '"')
            cell = cell.substr(1, cell.size() - 2);
    return cells;
}

/// Returns true for a line of names, also with some that nobody knows.
bool is_names(const std::vector<std::string_view>& cells) {
    constexpr std::array<std::string_view, 5> kSeveral{"Serial Number", "Date", "Time", "ObsG",
                                                       "Dial"};
    const auto known = std::ranges::count_if(kSeveral, [&](std::string_view name) {
        return std::ranges::find(cells, name) != cells.end();
    });
    return cells.front().starts_with("Station") && known >= 3;
}

class BurrisLines : public LineReader {
public:
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
            return Refusal{fmt::format("{} columns; allowed: 15, 16 or 20", cells.size())};
        join_note(cells, line, layout);
        Fields fields(layout, cells);
        const UtcTime time = fields.time({}, true);
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        layout_ = layout;
        is_month_first_ = is_month_first_ || parse_day(fields.text("date"))->is_month_first;
        Reading reading = fields.reading();
        reading.time = time;
        return reading;
    }

    [[nodiscard]] std::string layout() const override {
        return layout_.description + (is_month_first_ ? ", dates read as month/day/year" : "");
    }

private:
    /// Joins the cells of a note that has separators in it.
    static void join_note(std::vector<std::string_view>& cells, std::string_view line,
                          const Layout& layout) {
        const std::size_t last = layout.places.size() - 1;
        if (cells.size() <= last + 1 || layout.places[last].column->field != "note") return;
        cells[last] = line.substr(static_cast<std::size_t>(cells[last].data() - line.data()));
        cells.resize(last + 1);
    }

    Layout layout_;
    bool is_month_first_ = false;
};

}  // namespace

Format burris_format() {
    return {"ZLS Burris", "15, 16 or 20 columns",
            [](std::string_view line) {
                return !trimmed(line).empty() &&
                       (is_names(split(trimmed(line))) ||
                        std::holds_alternative<Reading>(BurrisLines().read(line)));
            },
            [](const ReadOptions&) -> std::unique_ptr<LineReader> {
                return std::make_unique<BurrisLines>();
            }};
}

}  // namespace a351::corrector::gravimeter
