#include "daemon/ctl/when.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <string>
#include <utility>

#include "protocol/text/csv_reader.hpp"

namespace a351::daemon::ctl {
namespace {

/// Reads -12min, -30s, -1.5h.
std::optional<UtcTime> parse_ago(std::string_view text, UtcTime now) {
    constexpr std::array<std::pair<std::string_view, double>, 3> kUnits_s{
        {{"min", 60.0}, {"s", 1.0}, {"h", 3600.0}}};
    for (const auto& [unit, seconds] : kUnits_s) {
        if (!text.starts_with('-') || !text.ends_with(unit)) continue;
        const auto count = text::parse_number(text.substr(1, text.size() - 1 - unit.size()));
        if (count && *count >= 0.0 && *count <= 1e5) return now - from_seconds(*count * seconds);
    }
    return std::nullopt;
}

/// A watch that is fast must not turn into the day before.
constexpr std::chrono::hours kAhead(1);

/// Returns the instant of a local time of the day of `now`, or of an earlier one.
///
/// The hour at the end of summer time occurs twice.  The latest of both that is not after `now` is
/// meant, because only the past was recorded.  A time that the beginning of summer time leaves out
/// is shifted by mktime().
UtcTime on_local_day(int days_ago, const std::array<int, 3>& time, UtcTime now) {
    const auto instant = [&](int is_summer_time) -> std::optional<UtcTime> {
        const std::time_t today =
            std::chrono::floor<std::chrono::seconds>(now).time_since_epoch().count();
        std::tm local{};
        localtime_r(&today, &local);
        local.tm_mday -= days_ago;
        local.tm_hour = time[0];
        local.tm_min = time[1];
        local.tm_sec = time[2];
        local.tm_isdst = is_summer_time;
        const std::time_t seconds = std::mktime(&local);
        // If the other offset is in force at this time, mktime() changes the local time.
        if (is_summer_time >= 0 && (local.tm_hour != time[0] || local.tm_min != time[1]))
            return std::nullopt;
        return UtcTime(std::chrono::seconds(seconds));
    };
    const auto summer = instant(1), winter = instant(0);
    if (!summer || !winter) return *instant(-1);
    const auto [earlier, later] = std::minmax(*summer, *winter);
    return later <= now ? later : earlier;
}

/// Reads HH:MM or HH:MM:SS of the host's zone, or with Z of UTC.
std::optional<UtcTime> parse_time_of_day(std::string_view text, UtcTime now) {
    const bool is_utc = text.ends_with('Z');
    if (is_utc) text.remove_suffix(1);
    const auto two = [&](std::size_t place, int largest) -> std::optional<int> {
        const char tens = text[place], ones = text[place + 1];
        if (tens < '0' || tens > '9' || ones < '0' || ones > '9') return std::nullopt;
        const int value = 10 * (tens - '0') + ones - '0';
        return value <= largest ? std::optional(value) : std::nullopt;
    };
    const bool has_seconds = text.size() == 8;
    if ((text.size() != 5 && !has_seconds) || text[2] != ':') return std::nullopt;
    if (has_seconds && text[5] != ':') return std::nullopt;
    const auto hour = two(0, 23), minute = two(3, 59),
               second = has_seconds ? two(6, 59) : std::optional(0);
    if (!hour || !minute || !second) return std::nullopt;
    std::optional<UtcTime> found;
    for (int days_ago = 0; days_ago <= 1 && (!found || *found > now + kAhead); ++days_ago)
        found = is_utc ? std::chrono::floor<std::chrono::days>(now) - std::chrono::days(days_ago) +
                             std::chrono::hours(*hour) + std::chrono::minutes(*minute) +
                             std::chrono::seconds(*second)
                       : on_local_day(days_ago, {*hour, *minute, *second}, now);
    return found;
}

}  // namespace

std::optional<UtcTime> parse_when(std::string_view text, UtcTime now) {
    if (const auto instant = parse_rfc3339(text)) return instant;
    if (const auto instant = parse_ago(text, now)) return instant;
    return parse_time_of_day(text, now);
}

}  // namespace a351::daemon::ctl
