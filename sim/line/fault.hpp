#pragma once
/// @file
/// What can go wrong with the sensor and its line, as written in a fault script or said through
/// the control socket.  Kinds and keys: a351-sim(1), FAULTS.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::sim {

enum class FaultKind {
    // Of single frames: each spoils the next `count` frames, one fault a frame.
    flip_bit,
    bad_checksum,
    drop_bytes,
    insert_bytes,
    garbage,
    duplicate_frame,
    reorder_frames,
    truncate_frame,
    lose_frames,
    // Of the device.
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
    // Of the line.
    silence,
    stall,
    hang_up,
    overrun,
    // Of the oven, which has kinds of its own.
    oven,
};

/// A number for each kind.
using FaultCounts = std::array<std::int64_t, static_cast<std::size_t>(FaultKind::oven) + 1>;

/// Which of the members mean something is the kind's business; the others keep their defaults.
struct Fault {
    FaultKind kind = FaultKind::flip_bit;
    std::string name;      ///< As written; of an oven fault, all that is known.
    int count = 1;         ///< Frames; counter_jump: samples; reorder_frames: pairs.
    int bits = 1;          ///< Flipped per frame, all in one 16-bit word or marker.
    int bytes = 1;         ///< Dropped or inserted per frame; of garbage.
    int ticks = 0;         ///< Of a counter_jump by no whole number of samples; 0: `count` samples.
    double seconds = 0.0;  ///< Simulated; 0 of an overrun: to the end.
    int diag_stat = 0;     ///< Bits of DIAG_STAT raised, or found by tests.
    bool loses_power = false;     ///< While unplugged.
    bool when_unplugged = false;  ///< Another unit comes with the next hang_up only.
    std::string serial_number;
    int output_rate_hz = 0;  ///< 0: as it is.  So with the next two.
    std::string filter;
    int burst_ctrl = 0;
    int baud = 0;
};

/// What faults are possible here.
struct FaultRules {
    const wire::DeviceProfile& profile;
    double speed = 1.0;                             ///< Simulated seconds per second.
    std::vector<std::string_view> oven_kinds = {};  ///< Names that are taken as oven faults.

    /// An overrun needs a host that gets along at this speed.
    static constexpr double kFastestOverrun = 50.0;
};

/// Reads the fault of a table; `kind` is its name, and the keys of other kinds are not asked for.
/// @throws InputError  unknown kind; a value out of range, or that the device does not know.
[[nodiscard]] Fault read_fault(text::TomlTable& table, const std::string& kind,
                               const FaultRules& rules);

/// The same from one line of words: `flip_bit count=3`.
/// @throws InputError  as read_fault; a word that is no key=value; an unknown key.
[[nodiscard]] Fault parse_fault(std::string_view words, const FaultRules& rules);

/// `seconds` from then, >= 0; UtcTime::max() when that is later than any run of the emulator.
[[nodiscard]] UtcTime later_by(double seconds, UtcTime then);

/// All but the oven's.
[[nodiscard]] std::span<const std::string_view> fault_kinds() noexcept;

}  // namespace a351::sim
