#pragma once
/// @file
/// Samples of the archive -> the regular record of one occupation.

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

namespace a351::corrector {

/// Instants origin + i / rate, i = 0 ... count - 1.
struct SampleGrid {
    UtcTime origin;
    double rate_hz = 0.0;
    std::size_t count = 0;
};

/// The grid on which the sensor sampled between two instants: it starts at the first sample within
/// [start, end) and has the rate that the longest piece shows between its time stamps, so that
/// a sensor some ppm off its nominal rate loses no sample.
/// @return std::nullopt without a sample in the window.
[[nodiscard]] std::optional<SampleGrid> sampling_grid(const std::vector<record::Segment>& segments,
                                                      UtcTime start, UtcTime end);

/// Puts segments on the grid, value = offset + gain x count; NaN where no sample is.  A segment
/// stays in one piece: its first sample decides.
[[nodiscard]] std::vector<double> place_on_grid(const std::vector<record::Segment>& segments,
                                                const record::ChannelScale& scale,
                                                const SampleGrid& grid);

/// The channels of a station that the corrector needs.
struct SurveyChannels {
    std::array<record::ChannelScale, 3> axes;  ///< x, y, z in m/s2.
    record::ChannelScale temperature;          ///< In degC, at the rate of the axes.
};

/// @throws InputError  a channel is missing or has another unit; `file` names the metadata.
[[nodiscard]] SurveyChannels find_channels(const record::StationMetadata& station,
                                           const std::filesystem::path& file);

/// A warning for each piece of its files that could not be read.
void add_damage(std::vector<std::string>& warnings, const record::ChannelData& channel);

/// The channels' samples over a survey.
struct SurveySamples {
    std::array<record::ChannelData, 3> axes;
    record::ChannelData temperature;
};

/// The record of one occupation; the temperature reaches some seconds beyond it on both sides.
/// @return std::nullopt without a sample of the vertical axis in the window.
[[nodiscard]] std::optional<OccupationRecord> cut_occupation(const SurveySamples& samples,
                                                             const SurveyChannels& channels,
                                                             UtcTime start, UtcTime end);

}  // namespace a351::corrector
