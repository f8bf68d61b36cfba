#include "daemon/page/history_json.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "daemon/page/message.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/whole_number.hpp"

namespace a351::daemon::page {
namespace {

constexpr std::size_t kMostPoints = 4000;
constexpr std::size_t kUsualPoints = 1000;
constexpr Nanoseconds kUsualSpan = std::chrono::hours(24);
constexpr std::array<std::string_view, live::kLiveChannelCount> kNames{"x", "y", "z",
                                                                       "temperature"};

constexpr std::array<std::pair<std::string_view, journal::OvenPlace>, 2> kOvens{
    {{"oven", journal::OvenPlace::inner}, {"outer_oven", journal::OvenPlace::outer}}};

using Keys = std::map<std::string, std::string>;

std::optional<UtcTime> instant(const Keys& keys, const std::string& key) {
    const auto found = keys.find(key);
    if (found == keys.end()) return std::nullopt;
    return parse_instant("query", key, found->second);
}

std::size_t point_count(const Keys& keys) {
    const auto found = keys.find("points");
    if (found == keys.end()) return kUsualPoints;
    const auto count = parse_whole<std::size_t>(found->second);
    if (!count || *count < 1 || *count > kMostPoints)
        throw InputError(
            fmt::format("query: key points = {}; allowed: 1 to {}", found->second, kMostPoints));
    return *count;
}

/// Appends `[t_ms, first, second]` with the fewest digits that reproduce the float; NaN is null.
void append_point(std::string& text, UtcTime time, std::array<float, 2> values) {
    text += text.ends_with('[') ? "[" : ",[";
    text += std::to_string(
        std::chrono::round<std::chrono::milliseconds>(time.time_since_epoch()).count());
    for (const float value : values) {
        text += ',';
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text += std::isfinite(value) ? std::string_view(digits.data(), end) : "null";
    }
    text += ']';
}

std::string body(std::string_view channel, std::string_view unit, double interval_s,
                 const std::string& points) {
    const nlohmann::json head = {{"channel", channel}, {"unit", unit}, {"interval_s", interval_s}};
    std::string text = head.dump();
    text.pop_back();
    return text + ",\"points\":" + points + "]}\n";
}

std::string oven_body(std::string_view channel, const std::vector<live::OvenPoint>& found) {
    std::string points = "[";
    double interval_s = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
        const auto& value = found[i].process_value;
        append_point(points, found[i].time,
                     {value ? static_cast<float>(value->value()) : kUnknown,
                      static_cast<float>(found[i].set_point.value())});
        if (i == 0) continue;
        const double step_s = seconds_between(found[i - 1].time, found[i].time);
        interval_s = i == 1 ? step_s : std::min(interval_s, step_s);
    }
    return body(channel, "degC", interval_s, points);
}

/// Returns the norm of the 2 s series.  Its points are doubles, because floats are 0.06 mGal apart at
/// the Earth's gravity.
std::string norm_body(const live::Record& live, UtcTime from, UtcTime to, std::size_t most) {
    const double values = seconds_between(from, to) / verdict::kLiveStepSeconds;
    constexpr double kMostJoined = 1e6;  // 23 days; an instant of the query may be centuries away.
    const double joined =
        std::clamp(std::ceil(values / static_cast<double>(most)), 1.0, kMostJoined);
    const auto interval = from_seconds(joined * verdict::kLiveStepSeconds);
    std::string points = "[";
    std::optional<UtcTime> begin;
    double low = 0.0, high = 0.0;
    const auto close = [&] {
        if (!begin) return;
        const auto ms = std::chrono::floor<std::chrono::milliseconds>(begin->time_since_epoch());
        points += fmt::format("{}[{},{:.3f},{:.3f}]", points.ends_with('[') ? "" : ",", ms.count(),
                              low, high);
    };
    for (const signal::MotionSample& one : live.motion(from, to)) {
        const double norm_mgal =
            std::hypot(one.axes[0].value(), one.axes[1].value(), one.axes[2].value());
        if (!std::isfinite(norm_mgal)) continue;
        const UtcTime bin(one.time.time_since_epoch() / interval * interval);
        if (begin != bin) {
            close();
            begin = bin;
            low = high = norm_mgal;
        }
        low = std::min(low, norm_mgal);
        high = std::max(high, norm_mgal);
    }
    close();
    return body("norm", "mGal", seconds_between(UtcTime{}, UtcTime(interval)), points);
}

}  // namespace

std::string history_json(const live::Record& live, std::string_view query, UtcTime now) {
    const auto keys = parse_query(query, {"channel", "from", "to", "points"});
    const UtcTime to = instant(keys, "to").value_or(now);
    const UtcTime from = instant(keys, "from").value_or(to - kUsualSpan);
    if (from >= to) throw InputError("query: key from: not before to");
    const std::size_t most = point_count(keys);

    const auto wanted = keys.find("channel");
    if (wanted == keys.end()) throw InputError("query: key channel is missing");
    for (const auto& [channel, place] : kOvens)
        if (wanted->second == channel)
            return oven_body(channel, live.oven_history(place, from, to, most));
    if (wanted->second == "norm") return norm_body(live, from, to, most);
    const auto name = std::ranges::find(kNames, wanted->second);
    if (name == kNames.end()) {
        throw InputError(fmt::format(
            "query: key channel = {}; allowed: x, y, z, norm, temperature, oven, outer_oven",
            wanted->second));
    }
    const auto channel = static_cast<live::Channel>(name - kNames.begin());
    const auto found = live.history(channel, from, to, most);
    std::string points = "[";
    for (const auto& one : found) append_point(points, one.time, {one.low, one.high});
    return body(*name, channel == live::Channel::temperature ? "degC" : "mg",
                found.empty() ? 0.0 : found.front().interval_s, points);
}

}  // namespace a351::daemon::page
