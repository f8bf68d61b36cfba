#pragma once
/// @file
/// Export of a channel on exact multiples of a period of UTC.

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
    csv,   ///< `time_utc,counts`, 17 significant digits; an empty line at each gap.
    mseed  ///< Records as in the archive, whole counts, location code 10.
};

struct ExportOptions {
    std::filesystem::path root;  ///< A data root.
    UtcTime from, to;            ///< Start, and end, which is not included.
    std::string channel;         ///< Channel of the archive, e.g. BNZ.
    int rate_hz = 50;            ///< Values per second, at most the rate of the channel.
    ExportFormat format = ExportFormat::csv;
};

/// Summary of an export.
struct ExportReport {
    std::int64_t values = 0;                    ///< Values written.
    std::int64_t runs = 0;                      ///< Runs without a gap.
    std::vector<record::ArchiveDamage> damage;  ///< Damaged records of the archive, each once.
};

/// Exports a channel on an exact grid of UTC, see UtcGrid.
///
/// It processes one day at a time, so that memory is bounded.  Location code 10 distinguishes the
/// product from the record, which has 00 or the code of the station.  The timing quality of the
/// records is 0, unknown; the archive and its channel LCQ have it.
/// @param write  takes the bytes in order.
/// @return a summary.
/// @throws InputError  no metadata, no samples of the channel in this time, a rate above that of
///                     the samples.
ExportReport export_channel(const ExportOptions& options,
                            const std::function<void(std::string_view)>& write);

}  // namespace a351::corrector
