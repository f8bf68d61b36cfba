#pragma once

#include "daemon/believable/limits.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::daemon::verdict {

/// Thresholds of the verdict, with defaults and sources.  Some are keys of [verdict]: a351d.toml(5),
/// config::read_verdict().
struct Options {
    // The oven.
    double operating_degc = unit::kTypicalUnit.set_point_degc;  ///< That of the published unit.
    double warm_up_degc = 1.0;     ///< Largest distance from it; a day in the field was within 0.5.
    double cycle_s = 900.0;        ///< Period of its cycle, s: 10 to 15 min were published.
    double history_min = 20.0;     ///< Time of temperature before it is judged: more than a cycle.

    // Effect of temperature on the reading: that of the typical unit, or of the calibration.
    /// Effect of the temperature.
    double static_mgal_per_degc = unit::kTypicalUnit.level_mgal_per_degc;
    /// Effect of its rate.
    double rate_mgal_h_per_degc = unit::kTypicalUnit.fast_mgal_per_degc_per_h;
    /// Effect of the clock oscillator, which follows the temperature with a lag.
    double slow_mgal_per_degc = unit::kTypicalUnit.slow_mgal_per_degc;
    double slow_lag_min = unit::kTypicalUnit.slow_lag_s / 60.0;  ///< Time constant of this lag.
    double relax_min = 17.0;  ///< Time constant of the box after a step of the air.
    double warm_up_mgal = unit::kTypicalUnit.warm_up_mgal;  ///< Effect at power-on.
    double warm_up_h = unit::kTypicalUnit.warm_up_h;        ///< Time constant of its decay.

    // Settled.
    double change_mgal = 2.0;        ///< Largest change in the next 10 min: the published scatter.
    double slope_degc_per_h = 0.25;  ///< Largest slope: three occupations left out had more.
    double sure = 2.2;       ///< Margin below change_mgal, in standard errors: 1 of 36 is wrong.
    double sure_stay = 1.4;  ///< The same margin while settled: 1 of 6 is wrong.
    /// Error of the expected change per degC between the box and the level that it relaxes to.
    double doubt_mgal_per_degc = 20.0;
    double hold_s = 20.0;  ///< Time for which all limits must be met: one temperature average.

    // Quiet.
    double knock_gal = 2.0;  ///< Knock, half peak to peak of an axis: a hand gives 5 or more.
    double quiet_s = 72.0;   ///< Time since the last knock: 1 min, and 12 s for its unseen end.
    double shake_gal = 0.3;  ///< Shaking, half peak to peak: above sensor noise and quiet ground.
    double shake_factor = 1.6;      ///< Ratio to its usual level, which shaking must also exceed.
    double shake_s = 10.0;          ///< Time since the last shaking: the reach of the live filters.
    double handled_s = 5.0;         ///< Length of a knock above which the box was handled.
    double watch_s = 110.0;         ///< Time since then: the lid may have been opened.
    double lid_degc = 0.05;         ///< Error that it adds to the level of the box: air 1 degC off.
    double lid_degc_per_h = 0.47;   ///< Error that it adds to its rate: air changing by 8 degC/h.
    double tilt_deg = 0.02;         ///< Change of tilt within a minute that means another place.
    double noise_factor = 5.0;      ///< Ratio of the noise to its usual level in the last hour.
    double noise_floor_mgal = 1.0;  ///< Lowest value taken as usual level: quiet field.

    // Data.
    double gap_s = 10.0;  ///< Time since the last good value: ten times the delay of a slow adapter.
    /// Time without any change of the temperature, after which it is frozen.
    double stuck_s = believable::kFrozen_s;

    bool operator==(const Options&) const = default;
};

}  // namespace a351::daemon::verdict
