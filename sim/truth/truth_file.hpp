#pragma once
/// @file
/// Record of the frames that were really sent; tests compare it with the recorded frames.
/// Format: sim/truth/truth-format.md.

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::sim::truth {

/// Fate of a frame on its way to the host.
enum class Fate : std::uint8_t {
    intact = 0,     ///< Arrived as the device made it; must be in the archive exactly once.
    damaged = 1,    ///< Arrived, but no receiver can use it.
    lost = 2,       ///< No byte of it arrived.
    repeated = 3,   ///< Arrived whole with the COUNT of the frame before: no new sample.
    misplaced = 4,  ///< Arrived whole with a COUNT that fits no sample; may be archived or not.
};

struct Record {
    UtcTime utc;  ///< Instant that the sample represents.
    wire::BurstValues values;
    std::uint16_t sampling_run = 0;
    std::uint32_t grid_index = 0;  ///< Index on the source's grid.
    Fate fate = Fate::intact;
};

class Writer {
public:
    /// Checks that `file` may be written: it does not exist, is empty, or is a truth file.
    /// @throws InputError  another regular file is there.
    static void require_own(const std::filesystem::path& file);

    /// @throws InputError         as require_own.
    /// @throws std::system_error  the file cannot be written; every other member throws this too.
    explicit Writer(std::filesystem::path file);

    void append(const Record& record);

    /// Writes the buffered records; the file is complete afterwards.
    void close();

private:
    void require_good() const;

    std::filesystem::path path_;
    std::ofstream out_;
};

}  // namespace a351::sim::truth
