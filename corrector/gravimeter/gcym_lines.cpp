#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/echo.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Network of all readings.  Source: the tables that geoist publishes.
constexpr std::string_view kNetwork = "GCYM";

/// Returns the instant of YYMMDDhhmm; the years are 1970 to 2069.
std::optional<UtcTime> time_of(std::string_view text, std::chrono::minutes zone) {
    if (text.size() != 10 || text.find_first_not_of("0123456789") != std::string_view::npos)
        return std::nullopt;
    const auto two = [&](std::size_t place) { return text.substr(place, 2); };
    return parse_rfc3339_in_zone(fmt::format("{}{}-{}-{}T{}:{}:00", two(0) < "70" ? "20" : "19",
                                             two(0), two(2), two(4), two(6), two(8)),
                                 zone);
}

/// The reader of tables for pyBACGS and LGADJ: one line a reading, without the tide of the meter.
class GcymLines : public LineReader {
public:
    explicit GcymLines(std::chrono::minutes zone) : zone_(zone) {}

    Line read(std::string_view line) override {
        const auto cells = split_at_blanks(line);
        if (cells.size() == 1) return mark(cells[0]);
        if (cells.empty()) return Comment{};
        const bool is_first = std::exchange(is_first_, false);
        // The line of the operator and the vehicle.
        if (is_first && cells.size() == 2 && cells[1] != kNetwork) return Comment{};
        const Fields fields(layout_, cells);
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        if (cells[1] != kNetwork)
            return Refusal{
                fmt::format("network = {}: allowed: {}", text::echoed(cells[1]), kNetwork)};
        const auto time = time_of(fields.text("minute_of_time"), zone_);
        if (!time) return Refusal{fmt::format("YYMMDDhhmm = {}: not an instant", cells[2])};
        Reading reading = fields.reading();
        reading.time = *time;
        reading.loop = loop_;
        return reading;
    }

    [[nodiscard]] std::string layout() const override {
        const auto minutes = std::abs(zone_.count());
        return fmt::format("{}, times in the zone {}{:02}:{:02}", layout_.description,
                           zone_.count() < 0 ? '-' : '+', minutes / 60, minutes % 60);
    }

private:
    /// Takes a line of one number: 55555 ends a loop; a break of the day and the end do not.
    Line mark(std::string_view cell) {
        constexpr std::array<std::string_view, 5> kMarks{"33333", "44444", "55555", "66666",
                                                         "99999"};
        if (std::ranges::find(kMarks, cell) == kMarks.end())
            return Refusal{fmt::format("{} columns; allowed: {}", 1, layout_.places.size())};
        if (cell == "55555") ++loop_;
        return Comment{};
    }

    std::chrono::minutes zone_;
    int loop_ = 1;
    bool is_first_ = true;  ///< The next line is the first one that is not blank.
    Layout layout_ = usual_layout(Form::gcym, usual_names(Form::gcym));
};

}  // namespace

Format gcym_format() {
    return {
        "GCYM table", "readings for pyBACGS or LGADJ, with --zone",
        [](std::string_view line) {
            return std::holds_alternative<Reading>(GcymLines(std::chrono::minutes(0)).read(line));
        },
        [](const ReadOptions& options) -> std::unique_ptr<LineReader> {
            if (!options.zone) return nullptr;
            return std::make_unique<GcymLines>(*options.zone);
        }};
}

}  // namespace a351::corrector::gravimeter
