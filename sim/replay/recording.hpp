#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/journal/journal_reader.hpp"
#include "sim/device/line_device.hpp"
#include "sim/device/register_machine.hpp"

namespace a351::sim::replay {

/// The unit that a recording was made with.
struct RecordedUnit {
    const wire::DeviceProfile* profile = nullptr;  ///< Not null.
    device::MachineIdentity identity;
    int baud = 460800;

    bool operator==(const RecordedUnit&) const = default;
};

/// Bytes of a file that could not be replayed.
using RecordingDamage = journal::Damage;

/// A recording: sessions, each one run of sampling, made of pieces.  The first session is the
/// current one at the beginning.
class Recording {
public:
    virtual ~Recording() = default;

    /// Returns the unit of the current session.
    [[nodiscard]] virtual const RecordedUnit& unit() const = 0;

    /// Returns when the next piece left the device, by the recording's own clock; std::nullopt at
    /// the end of the session.  The times of successive pieces never decrease.
    [[nodiscard]] virtual std::optional<UtcTime> next_due(
        const device::RegisterMachine& machine) const = 0;

    /// Hands over the next piece.  Precondition: next_due() has a value.
    /// @param machine  the emulated unit, in sampling mode.
    /// @param leaves   when the last byte leaves, in simulated time.
    virtual void send_next(device::RegisterMachine& machine, UtcTime leaves,
                           device::LineSink& line) = 0;

    /// Moves to the next session.  @return false if there is none.
    virtual bool begin_next_session() = 0;

    /// Returns, in words, how the settings of `machine` differ from the recorded ones; empty if
    /// they fit.
    [[nodiscard]] virtual std::string objection(const device::RegisterMachine& machine) const = 0;

    /// Returns the damage found so far.
    [[nodiscard]] virtual const std::vector<RecordingDamage>& damage() const = 0;

    /// Returns the number of samples so far that were left out because a channel lacks them.
    [[nodiscard]] virtual std::int64_t incomplete_samples() const { return 0; }
};

struct RecordingFiles {
    /// Journal segments or miniSEED files, distinguished by their first bytes.  A directory means
    /// the segments in it, or in its folder `journal`, or, if there are none, the day files below
    /// it.  In a directory, segments without a whole header are skipped and reported by
    /// Recording::damage().
    std::vector<std::filesystem::path> files;
    std::array<std::string, 3> axes{"1", "2", "Z"};  ///< Channels of x, y, z; for archives.
    RecordedUnit archive_unit = {};                  ///< Unit to emulate for an archive.
};

/// Opens the files.  Segments of one directory are replayed by number, directories in the order
/// given.
/// @throws InputError  a file is missing, empty or of neither kind; journal and miniSEED are mixed;
///         JournalRecording or ArchiveSource refuses the files.
[[nodiscard]] std::unique_ptr<Recording> open_recording(const RecordingFiles& input);

/// First and last instant of a recording, by its own clock.
struct Extent {
    UtcTime first, last;
    int sessions = 0;
};

/// Reads a recording to its end.
[[nodiscard]] Extent extent_of(Recording& recording);

}  // namespace a351::sim::replay
