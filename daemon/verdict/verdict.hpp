#pragma once
/// @file
/// What an operator who stands at a benchmark is told about the signal.  No threads, clocks or I/O.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
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

    [[nodiscard]] std::string to_text() const;  ///< "temperature slope 0.31 degC/h, limit 0.20"
};

struct Verdict {
    VerdictState state = VerdictState::no_data;
    UtcTime since;                ///< Begin of the state.
    std::vector<Reason> reasons;  ///< What is not met first.
};

/// Judges the live series.  From the worst to the best:
///
///     no data      no sample for gap_s; one that is not finite; a temperature that is stuck
///     warming up   farther than warm_up_degc from the set point; or the reading will change by more
///                  than change_mgal in the next 10 min and power-on was less than warm_up_h ago
///     disturbed    a knock within quiet_s, a hand at the box within watch_s, noise above usual
///     settling     temperature not known long enough; or its slope, its bend or the change of the
///                  reading that it announces above the limit
///     stable       none of these for hold_s
///
/// Limits of settling fall to enter_share of themselves until the verdict is stable.  A power-on
/// that nobody told is taken for the first sample when the box is then colder than warm_up_degc
/// below its set point.
class VerdictJudge {
public:
    explicit VerdictJudge(const VerdictOptions& options = {});

    /// When the sensor was switched on, where it is known.
    void switched_on(UtcTime time) { switched_on_ = time; }

    /// The next value of the series.
    const Verdict& take(const LiveSample& sample);

    /// Time goes by, with or without samples.
    const Verdict& at(UtcTime now);

    [[nodiscard]] const Verdict& verdict() const noexcept { return verdict_; }

private:
    void judge(UtcTime now);
    void decide(VerdictState state, UtcTime now, std::vector<Reason> reasons);

    VerdictOptions options_;
    TemperatureTrend trend_;
    TouchWatch touches_;
    std::optional<UtcTime> switched_on_;
    std::optional<UtcTime> first_seen_;
    std::optional<UtcTime> last_good_;    ///< Last finite sample seen.
    std::optional<UtcTime> stuck_since_;  ///< The temperature has its value from then on.
    double last_degc_ = 0.0;
    std::optional<UtcTime> steady_since_;
    bool has_judged_ = false;
    Verdict verdict_;
};

}  // namespace a351::daemon
