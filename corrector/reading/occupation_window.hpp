#pragma once
/// @file
/// From samples of the archive to the regular record of one occupation.

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

/// The instants origin + i / rate, i = 0 ... count - 1.
struct SampleGrid {
    UtcTime origin;
    double rate_hz = 0.0;
    std::size_t count = 0;
};

/// Returns the grid on which the sensor sampled between two instants.
///
/// The grid starts at the first sample within [start, end).  Its rate is that between the time
/// stamps of the longest piece, so that a sensor with a rate error of some ppm loses no sample;
/// tested at 80 ppm (tests/unit/reading/occupation_window_test.cpp).  If these stamps span less
/// than 60 s, it is the rate of the header, because then the rounding of the stamps is the larger
/// error.
/// @return the grid up to `end`; std::nullopt without a sample in the window.
[[nodiscard]] std::optional<SampleGrid> sampling_grid(const std::vector<record::Segment>& segments,
                                                      UtcTime start, UtcTime end);

/// Puts segments on the grid, value = offset + gain x count; NaN if there is no sample.  A segment
/// is placed by its first sample and not divided.
[[nodiscard]] std::vector<double> place_on_grid(const std::vector<record::Segment>& segments,
                                                const record::ChannelScale& scale,
                                                const SampleGrid& grid);

/// The channels of a station that the corrector needs.
struct SurveyChannels {
    std::array<record::ChannelScale, 3> axes;  ///< x, y, z in m/s2.
    record::ChannelScale temperature;          ///< degC, at the rate of the axes.
};

/// Finds the channels of the axes and of the temperature.
/// @param file  name of the metadata, for messages.
/// @throws InputError  a channel is missing or has another unit.
[[nodiscard]] SurveyChannels find_channels(const record::StationMetadata& station,
                                           const std::filesystem::path& file);

/// Adds a warning for each piece of the channel's files that could not be read.
void add_damage(std::vector<std::string>& warnings, const record::ChannelData& channel);

/// The samples of all channels over a survey.
struct SurveySamples {
    std::array<record::ChannelData, 3> axes;
    record::ChannelData temperature;
};

/// Returns the record of one occupation, axes in g.  The temperature extends 10 s (500 samples at
/// 50 Hz) beyond it on both sides.
/// @return std::nullopt without a sample of the vertical axis in the window.
[[nodiscard]] std::optional<OccupationRecord> cut_occupation(const SurveySamples& samples,
                                                             const SurveyChannels& channels,
                                                             UtcTime start, UtcTime end);

}  // namespace a351::corrector
