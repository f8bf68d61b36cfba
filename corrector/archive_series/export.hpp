#pragma once
/// @file
/// Export of a channel on exact multiples of a period of UTC.
///
/// The sensor samples on its own clock, so the times in the archive are not round.  Use an export
/// for programs that need a regular grid, or to compare with another instrument.  Do not use it for
/// a survey: the corrector takes the archive itself.
///
///     ExportOptions options{root, from, to, "BNZ", 50, "csv"};
///     const ExportReport report =
///         export_channel(options, [&](std::string_view bytes) { file.write(bytes); });
///
/// Values are counts of the channel, acceleration by the scale in station.xml of the data root, or the
/// tilt of a horizontal axis.

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::archive_series {

/// Returns the names of the formats.
/// - `csv`: for tables and plots: `time_utc,counts` or another unit, shortest exact digits with the
///   fractions of a count; an empty line at each gap.
/// - `mseed`: for seismological programs: records as in the archive, rounded to whole counts,
///   location code 10.
[[nodiscard]] std::vector<std::string> export_formats();

/// Part of a channel to be exported, and its form.
///
/// `from` is before `to`; both may be outside the archive.  `rate_hz` is 1 or more, and at most 1 %
/// above the rate of the channel.  A lower rate includes a low-pass filter (utc_grid.hpp).
struct ExportOptions {
    std::filesystem::path root;  ///< A data root.
    UtcTime from, to;            ///< Start, and end, which is not included.
    /// Channel of the archive, e.g. BNZ, or a tilt (tilt.hpp), which is computed at each instant of
    /// the grid from the three axes there, with their scales at `from`.
    std::string channel;
    int rate_hz = 50;            ///< Values per second, at most the rate of the channel.
    std::string format = "csv";  ///< One of export_formats(), not checked.
    /// Unit of the values: counts, mg (1e-3 of 9.80665 m/s2) or mgal; urad for a tilt; in miniSEED
    /// counts only, so that it has no tilt.
    std::string unit = "counts";
};

/// Summary of an export.  A run is a sequence of values without a gap on the grid.  Damaged records
/// are missing in the values, which is a gap.
struct ExportReport {
    std::int64_t values = 0;              ///< Values written.
    std::int64_t runs = 0;                ///< Runs without a gap.
    std::vector<archive::Damage> damage;  ///< Damaged records of the archive, each once.
    std::vector<text::Message> remarks;   ///< Days without a file (absent_files()), rate_remark().
    /// First instants that were written twice, because the host's clock was set back: begin and end.
    std::optional<std::array<UtcTime, 2>> twice;
};

/// Exports a channel on an exact grid of UTC, see UtcGrid.
///
/// It processes one day at a time, so that memory is bounded.  Location code 10 distinguishes the
/// product from the record, which has 00 or the code of the station.  The timing quality of the
/// records is 0, unknown; the archive and its channel LCQ have it.
///
/// Instants of the values are multiples of 1 / rate_hz since 1970, within [from, to).  Values are
/// missing on both sides of a gap, where the filter is not filled: 0.64 s for 50 Hz.  No value is
/// extrapolated.  Days are joined without a gap.  Nothing in the data root is changed.
///
/// In CSV a time has nine decimals.  The same options and archive give the same bytes.
/// @param options  see ExportOptions; a rate that is too high and a unit that does not fit are
///                 refused here.
/// @param write    takes the bytes in order, in pieces of any size; its exceptions are passed on.
/// @return a summary.
/// @throws InputError  no metadata, no samples of the channel in this time, a rate above that of
///                     the samples, a unit that is not that of the channel, a tilt from instants that
///                     occur twice.  A part of the output may have been written before.
ExportReport export_channel(const ExportOptions& options,
                            const std::function<void(std::string_view)>& write);

}  // namespace a351::corrector::archive_series
