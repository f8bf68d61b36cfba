#include "protocol/core/utc_time.hpp"

#include <fmt/core.h>

namespace a351 {
namespace {

using std::chrono::minutes;

/// Reads fixed-width fields from the front of a text; after the first failure failed() stays true.
class FieldReader {
public:
    explicit FieldReader(std::string_view text) : rest_(text) {}

    int digits(std::size_t width) {
        if (rest_.size() < width) return fail();
        int value = 0;
        for (const char c : rest_.substr(0, width)) {
            if (c < '0' || c > '9') return fail();
            value = value * 10 + (c - '0');
        }
        rest_.remove_prefix(width);
        return value;
    }

    bool take(char expected) {
        if (rest_.empty() || rest_.front() != expected) return false;
        rest_.remove_prefix(1);
        return true;
    }

    void require(char expected) {
        if (!take(expected)) fail();
    }

    Nanoseconds fraction() {
        std::int64_t value = 0;
        std::size_t seen = 0;
        for (; seen < rest_.size() && rest_[seen] >= '0' && rest_[seen] <= '9'; ++seen)
            if (seen < 9) value = value * 10 + (rest_[seen] - '0');
        if (seen == 0) fail();
        rest_.remove_prefix(seen);
        for (; seen < 9; ++seen) value *= 10;
        return Nanoseconds(value);
    }

    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    [[nodiscard]] bool failed() const { return failed_; }

private:
    int fail() {
        failed_ = true;
        return 0;
    }

    std::string_view rest_;
    bool failed_ = false;
};

std::optional<UtcTime> parse(std::string_view text, std::optional<minutes> default_zone) {
    FieldReader in(text);
    const std::chrono::year year(in.digits(4));
    in.require('-');
    const std::chrono::month month(static_cast<unsigned>(in.digits(2)));
    in.require('-');
    const std::chrono::day day(static_cast<unsigned>(in.digits(2)));
    if (!in.take('T')) in.require(' ');
    const int hour = in.digits(2);
    in.require(':');
    const int minute = in.digits(2);
    in.require(':');
    const int second = in.digits(2);
    const Nanoseconds fraction = in.take('.') ? in.fraction() : Nanoseconds(0);

    minutes zone(0);
    if (in.at_end() && default_zone) {
        zone = *default_zone;
    } else if (!in.take('Z')) {
        const bool west = in.take('-');
        if (!west) in.require('+');
        const int zone_hours = in.digits(2);
        in.require(':');
        const int zone_minutes = in.digits(2);
        if (zone_hours > 23 || zone_minutes > 59) return std::nullopt;
        zone = minutes(zone_hours * 60 + zone_minutes) * (west ? -1 : 1);
    }

    const std::chrono::year_month_day date(year, month, day);
    const bool in_range = year > std::chrono::year(1677) && year < std::chrono::year(2262);
    if (in.failed() || !in.at_end() || !date.ok() || !in_range || hour > 23 || minute > 59 ||
        second > 59) {
        return std::nullopt;
    }
    return UtcTime(std::chrono::sys_days(date)) + std::chrono::hours(hour) + minutes(minute) +
           std::chrono::seconds(second) + fraction - zone;
}

}  // namespace

std::optional<UtcTime> parse_rfc3339(std::string_view text) { return parse(text, std::nullopt); }

std::optional<UtcTime> parse_rfc3339_in_zone(std::string_view text, minutes zone) {
    return parse(text, zone);
}

std::string to_compact(UtcTime time) {
    std::string text = to_rfc3339(time);
    std::erase_if(text, [](char letter) { return letter == '-' || letter == ':'; });
    return text;
}

std::string to_rfc3339(UtcTime time, int decimals) {
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(time - day);
    std::string text =
        fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                    static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                    clock.hours().count(), clock.minutes().count(), clock.seconds().count());
    if (decimals > 0) {
        const std::string fraction = fmt::format(".{:09}", clock.subseconds().count());
        text += fraction.substr(0, static_cast<std::size_t>(decimals) + 1);
    }
    return text + 'Z';
}

}  // namespace a351
