#pragma once
/// @file
/// What was really sent, for tests to compare with what was recorded.  Format: sim/truth/truth-format.md.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::sim {

/// What became of a frame on its way to the host.
enum class Fate : std::uint8_t {
    intact = 0,     ///< Arrived as the device made it: exactly once in the archive.
    damaged = 1,    ///< Arrived, but no receiver can use it.
    lost = 2,       ///< Nothing of it arrived.
    repeated = 3,   ///< Arrived whole with the COUNT of the frame before: no new sample.
    misplaced = 4,  ///< Arrived whole with a COUNT that fits no sample: the receiver decides.
};

struct TruthRecord {
    UtcTime utc;  ///< Instant the sample stands for.
    wire::BurstValues values;
    std::uint16_t sampling_run = 0;
    std::uint32_t grid_index = 0;  ///< Sample of the scenario's grid.
    Fate fate = Fate::intact;
};

class TruthWriter {
public:
    /// A file that is there may be replaced: it is empty or a truth file.  None may be there.
    /// @throws InputError  it is something else.
    static void require_own(const std::filesystem::path& file);

    /// @throws InputError         as require_own.
    /// @throws std::system_error  the file cannot be written; so does every other member.
    explicit TruthWriter(std::filesystem::path file);

    void append(const TruthRecord& record);

    /// Writes what is buffered; the file is complete afterwards.
    void close();

private:
    void require_good() const;

    std::filesystem::path path_;
    std::ofstream out_;
};

/// @throws InputError  the file cannot be read or is no truth file.
[[nodiscard]] std::vector<TruthRecord> read_truth(const std::filesystem::path& file);

}  // namespace a351::sim
