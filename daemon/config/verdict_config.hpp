#pragma once

#include <chrono>

#include "daemon/source/host_clock.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::daemon::config {

/// Returns the defaults of [verdict] for a calibrated unit.  Its own response to temperature
/// replaces the published one, and its warm-up decays to within_mgal at after_power_on_h.
[[nodiscard]] verdict::Options thresholds_for(const unit::Calibration& unit);

/// Reads [verdict]: the keys have the names of their thresholds; absent ones are taken from
/// `defaults`.
/// @throws InputError  a value out of its range, or an unknown key.
[[nodiscard]] verdict::Options read_verdict(text::TomlTable table,
                                            const verdict::Options& defaults);

/// Age of the last sample from which there are no data.  Reason: a slow adapter delays samples by one
/// second.  The page has the same limit for the time in which it receives nothing.
inline constexpr std::chrono::seconds kStaleAfter{3};

/// Returns this age in instrument time; it is at least half a second of real time, a pause of the
/// host.
[[nodiscard]] Nanoseconds stale_after(const source::HostClock& clock);

}  // namespace a351::daemon::config
