#pragma once
/// @file
/// Channel codes of the archive.  protocol/archive/archive-format.md lists all channels.

#include <string>
#include <string_view>

namespace a351::archive {

/// Returns the SEED channel code: band code of a broad-band sensor at this rate, then instrument
/// and axis; BNZ at 50 Hz, HNZ at 100 Hz.  SEED reference manual 2.4, appendix A.
///
/// Band codes: B below 80 Hz, H below 250 Hz, C below 1000 Hz, F from 1000 Hz on.
/// @param rate_hz              output rate; SEED gives B from 10 Hz on, lower rates are not
///                             checked.
/// @param instrument_and_axis  two characters: N and the letter of the axis, or K1 for the raw
///                             temperature; not checked.
[[nodiscard]] inline std::string channel_code(int rate_hz, std::string_view instrument_and_axis) {
    const char band = rate_hz >= 1000 ? 'F' : rate_hz >= 250 ? 'C' : rate_hz >= 80 ? 'H' : 'B';
    return band + std::string(instrument_and_axis);
}

/// Codes of the derived channels; band code L is 1 Hz.  LCE and LCQ are also used by Quanterra
/// digitizers, so network tools know them.  The comment of each is the value of one count.
///
/// The oven's channels keep their codes if their sample interval is longer than 1 s.
inline constexpr std::string_view kSensorTemperature = "LK1";  ///< 0.001 degC
inline constexpr std::string_view kOvenTemperature = "LK2";    ///< Process value, 0.001 degC.
inline constexpr std::string_view kOvenSetPoint = "LK3";       ///< 0.001 degC
inline constexpr std::string_view kOvenHeating = "LYH";        ///< 0.01 %
inline constexpr std::string_view kOuterTemperature = "LK4";   ///< Outer oven, 0.001 degC.
inline constexpr std::string_view kOuterSetPoint = "LK5";      ///< Outer oven, 0.001 degC.
inline constexpr std::string_view kOuterHeating = "LYO";       ///< Outer oven, 0.01 %.
inline constexpr std::string_view kClockError = "LCE";         ///< 1 us
inline constexpr std::string_view kTimingQuality = "LCQ";      ///< 1 %

/// Returns true for the code of a derived channel: band code L.  Only the first letter is examined;
/// an empty code gives false.
[[nodiscard]] inline bool is_derived(std::string_view channel) { return channel.starts_with('L'); }

}  // namespace a351::archive
