#pragma once
/// @file
/// Epochs of the sensor in the station metadata, with the channels that the corrector needs.
///
/// A data root may contain records of several sensors, or of one with different settings.  Their
/// samples have different scales, so a long record is divided where an epoch ends.
///
///     const std::vector<Epoch> epochs = read_epochs(root / "metadata/station.xml");
///     for (std::size_t i = 1; i < epochs.size(); ++i)
///         warn(epochs[i].start, epoch_change(epochs[i - 1], epochs[i]));

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::archive_series {

/// Places in every list of channels: x and y come first.  The outer oven is the last one, and many
/// sensors do not have it.
inline constexpr std::size_t kVertical = 2, kTemperature = 3, kOuter = 4;

/// A period with one sensor and one scale of each channel.
///
/// It lasts until the start of the next epoch; the last one has no end.  `codes` are those of the
/// archive's file names.  Without a start date `start` is UtcTime::min().
struct Epoch {
    UtcTime start;
    std::string serial_number;  ///< Serial number of the sensor; empty: not known.
    journal::StationCodes codes;
    /// Scales of x, y, z in m/s2, temperature in degC and, if there is one, the temperature of an outer
    /// oven in degC: value = offset + gain x count.
    std::vector<station::ChannelScale> channels;
    std::optional<station::Position> position = {};  ///< Absent if the file has none.

    /// Metadata::noise_ug_per_sqrt_hz.
    std::optional<double> data_sheet_mgal_per_sqrt_hz = {};

    [[nodiscard]] bool has_outer() const { return channels.size() > kOuter; }
};

/// Finds the channels of the axes and of the temperature.
///
/// The code of an axis is any band letter, then N and the last letter of the axis
/// (StationCodes::axes).  The code of the temperature ends in K1.  Channels that begin with L, of 1
/// Hz, are derived and left out, except LK4, the temperature of an outer oven.  If several channels
/// fit, the first is taken.
///
/// @param start    start of the epoch.
/// @param station  from station::read_station_xml().
/// @param file     name of the metadata, for messages.
/// @throws InputError  a channel is missing or has another unit than m/s**2 or degC; the message
///                     has the channels that there are.
[[nodiscard]] Epoch epoch_of(UtcTime start, const station::Metadata& station,
                             const std::filesystem::path& file);

/// Reads the epochs in order of time; neighbours differ.  Samples before the first belong to the
/// first.
///
/// Epochs of the file that differ in other things only, for example the firmware, are joined
/// (archive_record_test.cpp).
/// @param metadata  station.xml.
/// @throws InputError  as read_station_xml() and epoch_of().
[[nodiscard]] std::vector<Epoch> read_epochs(const std::filesystem::path& metadata);

/// Returns the change from one epoch to the next: "another sensor: B after A", "another scale of
/// BNZ", "other channels"; empty if there is none.  The first that applies is returned, in the
/// order sensor, codes and channels, scale.  An outer oven is no change.
[[nodiscard]] text::Message epoch_change(const Epoch& before, const Epoch& after);

/// Returns "another sensor: B after A" for two serial numbers.
/// @return empty if both are the same, or if one is not known (empty).
[[nodiscard]] text::Message sensor_change(const std::string& before, const std::string& after);

}  // namespace a351::corrector::archive_series
