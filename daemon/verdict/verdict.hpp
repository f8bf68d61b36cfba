#pragma once
/// @file
/// What an operator who stands at a benchmark is told about the signal.  No threads, clocks or I/O.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/reading_slope.hpp"
#include "daemon/verdict/temperature_trend.hpp"
#include "daemon/verdict/touch_watch.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon {

enum class VerdictState { no_data, warming_up, disturbed, settling, stable };

[[nodiscard]] std::string_view to_text(
    VerdictState state) noexcept;  ///< "warming up" and the like.

/// One thing looked at.
struct Reason {
    const char* quantity = "";
    double value = 0.0;
    const char* unit = "";
    double limit = 0.0;
    bool is_least = false;  ///< The value must reach the limit; otherwise stay below it.
    bool is_met = false;
    double error = 0.0;  ///< Standard error of the value, where it has one: then the claim is sure.

    /// "temperature slope 0.31 degC/h, limit 0.25", "acceleration slope 2.1 +- 1.4 mGal/h, limit 12"
    [[nodiscard]] std::string to_text() const;
};

struct Verdict {
    VerdictState state = VerdictState::no_data;
    UtcTime since;                ///< Begin of the state.
    std::vector<Reason> reasons;  ///< What is not met first.
};

/// Judges the live series.  From the worst to the best:
///
///     no data      no sample for gap_s; one that is not finite; a temperature that is stuck
///     warming up   farther than warm_up_degc from the set point; or not yet settled and power-on was
///                  less than warm_up_h ago
///     disturbed    a knock within quiet_s, a hand at the box within watch_s, shaking within shake_s,
///                  noise above usual
///     settling     temperature not known long enough; its slope above the limit; the change of the
///                  reading that it announces not surely below; the slope of the reading surely above
///     stable       none of these for hold_s
///
/// Surely: by `sure` standard errors until it is settled, by `sure_stay` from then on until a hand is
/// at the box.  The first sample passes for power-on when the box is then colder than warm_up_degc
/// below its set point, or warms by half of that within an hour.
class VerdictJudge {
public:
    explicit VerdictJudge(const VerdictOptions& options = {});

    /// The next value of the series.
    const Verdict& take(const LiveSample& sample);

    /// Time goes by, with or without samples.
    const Verdict& at(UtcTime now);

    [[nodiscard]] const Verdict& verdict() const noexcept { return verdict_; }

private:
    void judge(UtcTime now);
    void follow_power(UtcTime seen_at, double degc);
    void decide(VerdictState state, UtcTime now, std::vector<Reason> reasons);

    VerdictOptions options_;
    TemperatureTrend trend_;
    TouchWatch touches_;
    ReadingSlope slope_;
    std::optional<UtcTime> switched_on_;
    std::optional<UtcTime> first_seen_;
    double first_degc_ = 0.0;
    std::optional<UtcTime> last_good_;    ///< Last finite sample seen.
    std::optional<UtcTime> stuck_since_;  ///< The temperature has its value from then on.
    double last_degc_ = 0.0;
    std::optional<UtcTime> steady_since_;  ///< Settled and warm, shaken or not.
    bool is_steady_ = false;
    bool has_judged_ = false;
    Verdict verdict_;
};

}  // namespace a351::daemon
