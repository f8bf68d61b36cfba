#pragma once
/// @file
/// The verdict on the signal, for an operator at a benchmark.  No threads, clocks or I/O.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/reading_slope.hpp"
#include "daemon/verdict/temperature_trend.hpp"
#include "daemon/verdict/touch_watch.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::verdict {

enum class State { no_data, warming_up, disturbed, settling, stable };

/// Reason of the state no_data: these are missing.
enum class Lack {
    samples,  ///< None arrive.
    values,   ///< Samples arrive, and the filters of the live series fill: at a start, after a gap.
    changes   ///< Values arrive, and the temperature is frozen.
};

/// Returns "warming up" and the like.
[[nodiscard]] std::string_view to_text(State state) noexcept;

/// One check of the verdict.
struct Reason {
    const char* quantity = "";
    double value = 0.0;
    const char* unit = "";
    const char* ending = "";  ///< Words after value and unit, for example "ago".
    double limit = 0.0;
    bool is_least = false;  ///< True: the value must reach the limit; false: must not exceed it.
    bool is_met = false;
    double error = 0.0;  ///< Standard error of the value if it has one; included in the check.

    /// Returns "temperature slope 0.31 degC/h (limit 0.25 degC/h)",
    /// "last knock 12 s ago (needs 72 s)" and the like.
    [[nodiscard]] text::Message to_message() const;
};

struct Verdict {
    State state = State::no_data;
    UtcTime since;                ///< Begin of the state.
    std::vector<Reason> reasons;  ///< Checks; those not met come first.
    /// Least time until the verdict can be stable; absent if temperature or noise decide, or without
    /// data.
    std::optional<double> time_left_s = {};
    Lack lack = Lack::samples;  ///< With the state no_data only.
};

/// Judges the live series.  From the worst to the best:
///
///     no data      no finite value for gap_s, or a temperature that does not change for stuck_s;
///                  without samples the page says it earlier (config::stale_after())
///     warming up   farther than warm_up_degc from the set point; or not settled yet and on for
///                  less than warm_up_h
///     disturbed    a knock within quiet_s, a touch within watch_s, shaking within shake_s, or
///                  noise above its usual level
///     settling     temperature not known for history_min; its slope above the limit; expected
///                  change of the reading not surely below the limit; or the slope of the
///                  reading surely above it
///     stable       none of these for hold_s
///
/// "Surely" means by `sure` standard errors until the box has settled, then by `sure_stay` until
/// the box is touched.  The first sample counts as power-on if the box is then more than
/// warm_up_degc below its set point, or warms by half of that within an hour.  A first sample after
/// a gap counts as such if the box is then so cold and was warmer by half of that before.
class Judge {
public:
    explicit Judge(const Options& options = {})
        : options_(options), trend_(options), touches_(options), slope_(options) {}

    /// Takes the next value of the series.
    const Verdict& take(const LiveSample& sample);

    /// Judges at this time of the data.
    const Verdict& at(UtcTime now);

    [[nodiscard]] const Verdict& verdict() const noexcept { return verdict_; }

private:
    void follow_power(UtcTime seen_at, double degc);
    const Verdict& decide(State state, UtcTime since, std::vector<Reason> reasons,
                          std::optional<double> time_left_s = std::nullopt);

    Options options_;
    TemperatureTrend trend_;
    TouchWatch touches_;
    ReadingSlope slope_;
    std::optional<UtcTime> switched_on_;
    bool was_switched_off_ = false;  ///< Before that, while it was watched.
    std::optional<UtcTime> first_seen_;
    double first_degc_ = 0.0;
    std::optional<UtcTime> last_good_;    ///< Last finite sample seen.
    std::optional<UtcTime> stuck_since_;  ///< Time since which the temperature has not changed.
    double last_degc_ = 0.0;
    std::optional<UtcTime> steady_since_;  ///< Settled and warm since then, shaken or not.
    bool is_steady_ = false;
    bool has_judged_ = false;
    Verdict verdict_;
};

}  // namespace a351::daemon::verdict
