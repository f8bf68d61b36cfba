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

struct TruthRecord {
    UtcTime utc;  ///< Instant the sample stands for.
    wire::BurstValues values;
    std::uint16_t sampling_run = 0;
    std::uint32_t grid_index = 0;  ///< Sample of the scenario's grid.
};

class TruthWriter {
public:
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
