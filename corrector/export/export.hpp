#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

enum class ExportFormat {
    csv,   ///< `time_utc,counts`, 17 significant digits, an empty line where values are missing.
    mseed  ///< Records as of the archive, whole counts, location code 10.
};

struct ExportOptions {
    std::filesystem::path root;  ///< A data root.
    UtcTime from, to;            ///< [from, to)
    std::string channel;         ///< As in the archive, e.g. BNZ.
    int rate_hz = 50;
    ExportFormat format = ExportFormat::csv;
};

struct ExportReport {
    std::int64_t values = 0;
    std::int64_t runs = 0;  ///< Without a gap.
    std::vector<record::ArchiveDamage> damage;
};

/// A channel on an exact grid of UTC, see UtcGrid; a day at a time, so that memory is bounded.
/// Location code 10 tells the product from the record, which is 00 or what the station says.
/// Timing quality of the records is 0, unknown: the archive's own and its channel LCQ tell it.
/// @param write  takes the bytes in order.
/// @throws InputError  no metadata; no samples of the channel then; a rate above the samples'.
ExportReport export_channel(const ExportOptions& options,
                            const std::function<void(std::string_view)>& write);

}  // namespace a351::corrector
