#pragma once
/// @file
/// The samples of a sensor's channels, as the archive has them: counts, with the times of the records.
///
///     const Epoch epoch = epoch_of(start, station, metadata_file);
///     const std::vector<archive::ChannelData> samples = read_samples(root, epoch, {from, from, to});
///     for (const archive::ChannelData& channel : samples) add_damage(warnings, channel);
///     const auto grid = sampling_grid(samples[kVertical].segments, start, end);
///
/// The order of the channels is that of Epoch::channels.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "corrector/archive_series/epoch.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::archive_series {

/// An interval of time to be read.  The temperatures may begin earlier than the axes, because the
/// response to them has a memory.
struct Span {
    UtcTime axes_from;         ///< Start of the axes.
    UtcTime temperature_from;  ///< Start of the temperatures.
    UtcTime to;                ///< End of all channels, not included.

    /// Returns the start of a channel, by its place.
    [[nodiscard]] UtcTime from(std::size_t channel) const {
        return channel <= kVertical ? axes_from : temperature_from;
    }
};

/// Reads all channels of an epoch, on all cores.  A channel without samples is no error.
/// @param root  data root; its folder `archive` is read.
/// @param earlier  samples that are not needed any more.  Their memory is used again: with new
///                 memory for each day a week takes a quarter more time.
/// @throws std::system_error  a file cannot be read, or no thread started.
[[nodiscard]] std::vector<archive::ChannelData> read_samples(
    const std::filesystem::path& root, const Epoch& epoch, const Span& span,
    std::vector<archive::ChannelData> earlier = {});

/// Returns the day files of all channels in the span, by channel and day.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& root,
                                                          const Epoch& epoch, const Span& span);

/// Returns the time of the last sample.
/// @param channel  has at least one.
[[nodiscard]] UtcTime last_sample(const archive::ChannelData& channel);

/// Adds the samples that have not reached the archive.  A journal segment that the daemon has just
/// compressed is looked for once more.
/// @param samples  of read_samples() for the same epoch and span.
/// @return the newest clock reading of the journal; std::nullopt if the archive is complete, or if the
///         journal continued after the span.
/// @throws std::system_error  a segment of the journal cannot be read.
std::optional<UtcTime> add_journaled(std::vector<archive::ChannelData>& samples,
                                     const std::filesystem::path& root, const Epoch& epoch,
                                     const Span& span);

/// Returns the day files of the sensor's channels in [from, to) that are absent although another of these
/// channels has one, by day; see archive::absent_day_files().
/// @throws InputError  as station::read_station_epochs().
[[nodiscard]] std::vector<archive::AbsentFile> absent_files(const std::filesystem::path& root,
                                                            UtcTime from, UtcTime to);

/// Returns "BNZ has no day file of 2026-03-01, but ...".
[[nodiscard]] text::Message to_message(const archive::AbsentFile& absent);

/// Returns one sentence on the channels whose headers have another rate than the metadata: both rates,
/// that of the record starts, the one that is used, and the size of the effect.  Empty: none has.
[[nodiscard]] text::Message rate_remark(std::span<const archive::ChannelData> samples);

/// Adds a warning for each piece of the channel's files that could not be read.  The English text is
/// that of archive::to_text(); earlier warnings are kept.
void add_damage(std::vector<text::Message>& warnings, const archive::ChannelData& channel);

}  // namespace a351::corrector::archive_series
