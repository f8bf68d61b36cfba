#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/device/line_device.hpp"
#include "sim/device/register_machine.hpp"

namespace a351::sim {

/// The unit that a recording was made with.
struct RecordedUnit {
    const wire::DeviceProfile* profile = nullptr;  ///< Not null.
    MachineIdentity identity;
    int baud = 460800;
};

/// Bytes of a file that could not be replayed.
struct RecordingDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
    std::string reason;
};

/// A recording: sessions, each one run of sampling, made of pieces.  The first session is the
/// current one at the beginning.
class Recording {
public:
    virtual ~Recording() = default;

    /// Returns the unit of the current session.
    [[nodiscard]] virtual const RecordedUnit& unit() const = 0;

    /// Returns when the next piece left the device, by the recording's own clock; std::nullopt at
    /// the end of the session.  The times of successive pieces never decrease.
    [[nodiscard]] virtual std::optional<UtcTime> next_due(const RegisterMachine& machine) const = 0;

    /// Hands over the next piece.  Precondition: next_due() has a value.
    /// @param machine  the emulated unit, in sampling mode.
    /// @param leaves   when the last byte leaves, in simulated time.
    virtual void send_next(RegisterMachine& machine, UtcTime leaves, LineSink& line) = 0;

    /// Moves to the next session.  @return false if there is none.
    virtual bool begin_next_session() = 0;

    /// Returns, in words, how the settings of `machine` differ from the recorded ones; empty if
    /// they fit.
    [[nodiscard]] virtual std::string objection(const RegisterMachine& machine) const = 0;

    /// Returns the damage found so far.
    [[nodiscard]] virtual const std::vector<RecordingDamage>& damage() const = 0;

    /// Returns the number of samples so far that were left out because a channel lacks them.
    [[nodiscard]] virtual std::int64_t incomplete_samples() const { return 0; }
};

}  // namespace a351::sim
