#pragma once
/// @file
/// Limits within which values of the sensor are believable.

#include "protocol/core/sensor_limits.hpp"
#include "protocol/core/units.hpp"

namespace a351::daemon::believable {

/// Largest half peak-to-peak value of an axis in a second for a box at rest, as a share of its norm,
/// so that a wrong scale does not hide it.  The sensor's noise and traffic are below 0.0005.
inline constexpr double kMostRestlessness = 0.02;
/// Smallest norm that this share is taken of: that of a box whose vertical axis is dead.
inline constexpr StandardGravity kLeastScale(0.1);

/// Least share of the norm on an axis that is called vertical: it is within 10 degrees of the vertical.
/// A bias of 7 mg of another axis changes the norm by less than 1.2 mg there.
inline constexpr double kLeastVertical = 0.985;
/// Time at rest after which the stance of a box is known, s.  Nobody carries a box so still, and for so
/// long.
inline constexpr int kStance_s = 10;
/// Time at rest of which a norm is the mean, s.
inline constexpr int kMinute_s = 60;
/// Largest change of the norm at rest: half of 1 %.  The bias changes by 2 mg at most over temperature,
/// and by 1.2 mg within kLeastVertical (see is_norm_believable()); gravity by less than 1 mg between the
/// sites of a day, which are within 3 km in height (0.3 mGal/m).
inline constexpr StandardGravity kMostNormChange(0.005);
/// Minutes at rest for which a change of the norm must last.
inline constexpr int kNormMinutes = 5;

/// Share of the rated range beyond which no axis can be: the sensor limits its output to the range.
inline constexpr double kMostOfRange = 1.1;

/// Largest excess of the changes of a higher byte over those of the lowest one, as a share of the
/// samples.  A change of a higher byte leaves the lowest one as it is in 1 of 256 cases.  If the bytes
/// of a word are exchanged, the excess is 0.2 in traffic of 20 mGal, and nearly 1 in a quiet room.
inline constexpr double kMostByteExcess = 0.05;

/// Largest difference between the temperatures of the sensor and of its oven: the heat of the
/// sensor and the errors of both thermometers, with a margin.  The published unit in its oven was
/// within 1 degC.
inline constexpr double kMostFromOven_degc = 5.0;

/// Returns true if a sensor in this oven can have this temperature.
[[nodiscard]] constexpr bool is_near_oven(DegC temperature, DegC oven) noexcept {
    const double difference_degc = (temperature - oven).value();
    return difference_degc <= kMostFromOven_degc && -difference_degc <= kMostFromOven_degc;
}

/// Temperatures of a room, a box or an oven.  At 7.17 degC the format of the M-A352AD10 and counts of
/// 1/1024 degC give the same; where one of them gives more, the other one gives less.
inline constexpr DegC kLeastUsual(7.2), kMostUsual(60.0);

[[nodiscard]] constexpr bool is_temperature_usual(DegC temperature) noexcept {
    return temperature >= kLeastUsual && temperature <= kMostUsual;
}

/// Largest difference between an oven and its set point that counts as reached.  The published oven
/// was within 0.5 degC.
inline constexpr double kAtSetPoint_degc = 1.0;
/// Largest change in 10 min of a sensor that does not follow its oven.  A box that approaches its
/// oven from 5 degC away changes by more if its time constant is below kSlowestBox_s.
inline constexpr double kMostStill_degc = 0.5;
/// Time constant with which a box approaches its oven, at most, s.  That of the published box is 17 min.
inline constexpr double kSlowestBox_s = 95.0 * 60.0;

/// Age of the oven's last answer above which its temperature is not known, s.
inline constexpr double kOldAnswer_s = 120.0;

/// Time without any change after which a temperature is frozen, s.  A quiet oven changes by one count
/// of 0.0038 degC in two minutes, and the sensor's noise is several counts.
inline constexpr int kFrozen_s = 600;
/// Step of the temperature for which kFrozen_s is valid, degC: M-A352AD10 data sheet rev. 20251023,
/// 7.6.  A coarser counter changes less often.
inline constexpr double kUsualStep_degc = 0.0037918;
/// Ratio of a frozen time to the longest pause before, for a unit with little noise.
inline constexpr int kFrozenPauses = 5;

/// Time for which every other trouble must last, s.
inline constexpr int kConfirm_s = 6;
/// Gap of the samples after which the watch begins again, s: another sensor may be there.
inline constexpr double kLongGap_s = 10.0;

}  // namespace a351::daemon::believable
