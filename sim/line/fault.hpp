#pragma once
/// @file
/// Faults of the sensor and its line, as written in a fault script or sent through the control
/// socket.  Kinds and keys: a351-faults.toml(5).

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::sim::line {

enum class FaultKind {
    // Faults of frames come first: each damages the next `count` frames; a frame has one at most.
    flip_bit,
    bad_checksum,
    drop_bytes,
    insert_bytes,
    garbage,
    duplicate_frame,
    reorder_frames,
    truncate_frame,
    lose_frames,
    // Faults of the device.  Those up to error_flags begin with the next frame.
    counter_jump,
    counter_stuck,
    counter_reset,
    error_flags,
    reset,
    power_cycle,
    stop,
    other_unit,
    change_settings,
    change_baud,
    failing_tests,
    // Faults of the line.
    silence,
    stall,
    hang_up,
    overrun,
    // Faults of the oven, whose kinds oven::Port knows by name.
    oven,
};

/// A number for each kind.
using FaultCounts = std::array<std::int64_t, static_cast<std::size_t>(FaultKind::oven) + 1>;

/// A fault.  Its kind determines which members are used; the others keep their defaults.
struct Fault {
    FaultKind kind = FaultKind::flip_bit;
    std::string name;             ///< Name as written; the only identification of an oven fault.
    int count = 1;                ///< Frames; counter_jump: samples; reorder_frames: pairs.
    int bits = 1;                 ///< Flipped per frame, all in one 16-bit word or marker.
    int bytes = 1;                ///< Dropped or inserted per frame, or length of the garbage.
    int ticks = 0;                ///< Length of a counter_jump, 250 us each; 0: `count` samples.
    double seconds = 0.0;         ///< Simulated; 0 for overrun: to the end.
    int diag_stat = 0;            ///< Bits of DIAG_STAT to raise, or that tests find.
    bool loses_power = false;     ///< The device has no power while unplugged.
    bool when_unplugged = false;  ///< The other unit comes with the next hang_up.
    std::string serial_number;
    int output_rate_hz = 0;  ///< 0, as empty or 0 in the next three: unchanged.
    std::string filter;
    int burst_ctrl = 0;
    int baud = 0;
};

/// Limits on the faults of one run.
struct FaultRules {
    const wire::DeviceProfile& profile;
    double speed = 1.0;                             ///< Simulated seconds per real second.
    std::vector<std::string_view> oven_kinds = {};  ///< Names accepted as oven faults.

    /// Highest speed at which an overrun is accepted: the host must be able to keep up.
    static constexpr double kFastestOverrun = 50.0;
};

/// Reads the fault of a table.  Keys of other kinds are left for require_all_read() to refuse.
/// @param kind  name of the fault.
/// @throws InputError  unknown kind; a value that is out of range or unknown to the device.
[[nodiscard]] Fault read_fault(text::TomlTable& table, const std::string& kind,
                               const FaultRules& rules);

/// Reads a fault from one line of words, such as `flip_bit count=3`.
/// @throws InputError  as read_fault(); a word that is not key=value; an unknown key.
[[nodiscard]] Fault parse_fault(std::string_view words, const FaultRules& rules);

/// Returns `then` plus `seconds`, >= 0; UtcTime::max() if the wait is longer than any run.
[[nodiscard]] UtcTime later_by(double seconds, UtcTime then);

/// Returns the names of all faults except those of the oven.
[[nodiscard]] std::span<const std::string_view> fault_kinds() noexcept;

}  // namespace a351::sim::line
