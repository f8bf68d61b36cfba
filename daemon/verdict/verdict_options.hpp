#pragma once

namespace a351::daemon {

/// Thresholds of the verdict: the keys of [verdict], with their defaults and reasons.
struct VerdictOptions {
    // The oven.
    double operating_degc = 42.5;  ///< Its set point: the published unit was kept there.
    double warm_up_degc = 1.0;  ///< Farther off: warming up.  A day in the field kept within 0.5.
    double cycle_s = 900.0;     ///< Its cycle, no unsteadiness: 10 to 15 min published.
    double history_min = 20.0;  ///< Of temperature, before it is judged: a cycle and a bit.

    // What temperature does to the reading, as fitted to the published records.
    double static_mgal_per_degc = -12.0;  ///< At once.
    double rate_mgal_h_per_degc = 11.3;   ///< By rate: compensation 43 s ahead of the crystal.
    double slow_mgal_per_degc = -20.0;    ///< By the clock oscillator, lagging by ...
    double slow_lag_min = 45.0;
    double relax_min = 17.0;     ///< Time constant of the box after a step of the air.
    double warm_up_mgal = 36.0;  ///< Since power-on, decaying with ...
    double warm_up_h = 2.5;

    // Settled.
    double change_mgal = 2.0;  ///< Within the next 10 min: the scatter of the published survey.
    double slope_degc_per_h = 0.25;  ///< What the three occupations it left out had and more.
    double sure = 2.2;       ///< Standard errors by which the change must be below: 1 of 36 is not.
    double sure_stay = 1.4;  ///< So many once it is stable: 1 of 6 is not.
    /// Error of that change, by what the box is off the level that it relaxes to.
    double doubt_mgal_per_degc = 20.0;
    double hold_s = 20.0;  ///< So long below: one mean of the temperature.

    // Quiet.
    double knock_gal = 2.0;        ///< Half peak to peak of an axis: a hand gives 5 and more.
    double quiet_s = 72.0;         ///< Since the last knock: a minute, and the end of one, unseen.
    double shake_gal = 0.3;        ///< Above the sensor's noise and a quiet ground, ...
    double shake_factor = 1.6;     ///< ... or so much above its usual level: something passes.
    double shake_s = 10.0;         ///< Since then: the reach of the live filters.
    double handled_s = 5.0;        ///< A longer one is a hand, which may have opened the lid ...
    double watch_s = 110.0;        ///< ... and the temperature is watched for so long.
    double lid_degc = 0.05;        ///< What that may do to the level of the box: air 1 degC off ...
    double lid_degc_per_h = 0.47;  ///< ... and to its rate: air that goes 8 degC/h.
    double tilt_deg = 0.02;        ///< Another tilt than before: brought to a new place.
    double noise_factor = 5.0;     ///< Of the 2 s series, to its usual level of the last hour.
    double noise_floor_mgal = 1.0;  ///< Less is not noise: the ripple of the field has 1 mGal.

    // An occupation.
    double cycle_mgal = 6.0;   ///< Published swing of the reading in the cycle, peak to peak.
    double target_mgal = 1.0;  ///< Standard error, good enough: below the 1.2 of one placement.

    // Data.
    double gap_s = 10.0;    ///< Since the last sample: ten times what a slow adapter holds back.
    double stuck_s = 60.0;  ///< Temperature the same to the last digit: 30 noisy values.

    bool operator==(const VerdictOptions&) const = default;
};

}  // namespace a351::daemon
