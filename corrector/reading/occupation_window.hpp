#pragma once
/// @file
/// From samples of the archive to the regular record of one occupation.
///
/// The archive has segments of counts with time stamps.  A record has values on a regular grid,
/// with NaN where there is no sample.  Samples are moved to the nearest instant of the grid, never
/// interpolated.  Order of use:
///
///     const SurveyChannels channels = find_channels(station, metadata_file);
///     SurveySamples samples;    // read once for the whole survey, with archive::read_channel()
///     const auto record = cut_occupation(samples, channels, window.start, window.end);
///     if (!record) leave_out(...);
///
/// The functions are pure, so several occupations may be cut at once.

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/representative_value.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::reading {

/// The instants origin + i / rate, i = 0 ... count - 1.
/// A default-constructed grid is empty and must not be used.
struct SampleGrid {
    UtcTime origin;         ///< Instant of sample 0.
    double rate_hz = 0.0;   ///< Rate, Hz, > 0.
    std::size_t count = 0;  ///< Number of instants, >= 1.
};

/// Returns the grid on which the sensor sampled between two instants.
///
/// The grid starts at the first sample within [start, end).  Its rate is that between the time
/// stamps of the longest piece, so that a sensor with a rate error of some ppm loses no sample;
/// tested at 80 ppm (tests/unit/reading/occupation_window_test.cpp).  If these stamps span less
/// than 60 s, it is the rate of the header, because then the rounding of the stamps is the larger
/// error.
///
/// @param segments    of one channel, in any order; each has an anchor at its first sample.
/// @param start, end  window [start, end); start <= end, which is not checked.
/// @return the grid up to `end`; std::nullopt without a sample in the window.  The last instant is
///         0.5 to 1.5 samples before `end`, so that rounded stamps do not change the count.
[[nodiscard]] std::optional<SampleGrid> sampling_grid(const std::vector<archive::Segment>& segments,
                                                      UtcTime start, UtcTime end);

/// Puts segments on the grid, value = offset + gain x count; NaN if there is no sample.  A segment
/// is placed by its first sample and not divided.
///
/// Samples more than half a step before the origin are left out.  The first of the others is put at
/// the nearest instant, and those after it follow one by one.  Within a segment no sample is lost
/// or doubled.  After a long segment at another rate they are off their instants by the drift.
///
/// Samples beyond the last instant are left out.  If two segments claim an instant, the later one
/// in the list has it.
///
/// @param segments  of one channel, in order of time.
/// @param scale     gain and offset of the channel.
/// @return (grid.count) values in the unit of the scale.
[[nodiscard]] std::vector<double> place_on_grid(const std::vector<archive::Segment>& segments,
                                                const station::ChannelScale& scale,
                                                const SampleGrid& grid);

/// The channels of a station that the corrector needs.
struct SurveyChannels {
    std::array<station::ChannelScale, 3> axes;  ///< x, y, z in m/s2.
    station::ChannelScale temperature;          ///< degC, at the rate of the axes.
    /// Temperature of an outer oven, degC; absent if the box has none.
    std::optional<station::ChannelScale> outer;
};

/// Finds the channels of the axes and of the temperature.
///
/// The code of an axis is any band letter, then N and the last letter of the axis
/// (StationCodes::axes).  The code of the temperature ends in K1.  Channels that begin with L, of 1
/// Hz, are derived and left out, except LK4, the temperature of an outer oven.  If several channels
/// fit, the first is taken.
///
/// @param station  from station::read_station_xml().
/// @param file  name of the metadata, for messages.
/// @throws InputError  a channel is missing or has another unit than m/s**2 or degC; the message
///                     has the channels that there are.
[[nodiscard]] SurveyChannels find_channels(const station::Metadata& station,
                                           const std::filesystem::path& file);

/// Adds a warning for each piece of the channel's files that could not be read.  The text is that
/// of record::to_text(); earlier warnings are kept.
void add_damage(std::vector<text::Message>& warnings, const archive::ChannelData& channel);

/// The samples of all channels over a survey.
/// The temperature should begin earlier than the axes, for the whole-day model.
struct SurveySamples {
    std::array<archive::ChannelData, 3> axes;  ///< x, y, z.
    archive::ChannelData temperature;
    archive::ChannelData outer;          ///< Without samples if the box has no outer oven.
    std::optional<UtcTime> journal_end;  ///< OccupationRows::as_of, if samples are of the journal.
};

/// Returns the record of one occupation, axes in g.  The temperature extends 10 s (500 samples at
/// 50 Hz) beyond it on both sides.
///
/// The grid is that of the vertical axis; x and y are placed on it.  A horizontal axis or a
/// temperature without samples is NaN throughout, which is no error.
///
/// @param start, end  window [start, end), start <= end.
/// @return std::nullopt without a sample of the vertical axis in the window.
[[nodiscard]] std::optional<OccupationRecord> cut_occupation(const SurveySamples& samples,
                                                             const SurveyChannels& channels,
                                                             UtcTime start, UtcTime end);

}  // namespace a351::corrector::reading
