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

/// What could not be replayed.
struct RecordingDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
    std::string reason;
};

/// Something recorded earlier, piece by piece, in sessions: runs of sampling.  It stands in its
/// first session from the beginning.
class Recording {
public:
    virtual ~Recording() = default;

    /// Of the session it stands in.
    [[nodiscard]] virtual const RecordedUnit& unit() const = 0;

    /// By the recording's own clock, when the next piece left the device; std::nullopt at the end
    /// of the session.  Never before that of the piece before.
    [[nodiscard]] virtual std::optional<UtcTime> next_due(const RegisterMachine& machine) const = 0;

    /// Hands over the next piece.  Precondition: next_due() has a value.
    /// @param machine  samples.
    /// @param leaves   when the last byte leaves, on simulated time.
    virtual void send_next(RegisterMachine& machine, UtcTime leaves, LineSink& line) = 0;

    /// Goes on to the next session.  @return false when there is none.
    virtual bool begin_next_session() = 0;

    /// In words, how the settings of `machine` differ from what was recorded; empty if they fit.
    [[nodiscard]] virtual std::string objection(const RegisterMachine& machine) const = 0;

    /// Met so far.
    [[nodiscard]] virtual const std::vector<RecordingDamage>& damage() const = 0;

    /// Samples so far of which a channel is missing, left out for that.
    [[nodiscard]] virtual std::int64_t incomplete_samples() const { return 0; }
};

}  // namespace a351::sim
