#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

#include "daemon/source/host_clock.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::source {

/// A fast emulator is not asked without a pause.
inline constexpr std::chrono::milliseconds kShortestRealWait{50};

/// Returns a span of instrument time in real time, at least kShortestRealWait.
inline Nanoseconds real_wait_of(const HostClock& clock, Nanoseconds instrument_span) {
    return std::max<Nanoseconds>(kShortestRealWait, clock.real_span(instrument_span));
}

/// Returns the pause after failures in a row, instrument time.
/// @param failures  those before this one.
inline std::chrono::seconds back_off_of(std::size_t failures) {
    constexpr std::array kPauses_s{1, 2, 5, 10, 30};
    return std::chrono::seconds(kPauses_s.at(std::min(failures, kPauses_s.size() - 1)));
}

}  // namespace a351::daemon::source
