#include "corrector/archive_series/epoch.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/archive/channel_code.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::archive_series {
namespace {

void require_unit(const station::ChannelScale& channel, const char* unit,
                  const std::filesystem::path& file) {
    if (channel.unit != unit)
        throw InputError(fmt::format("{}: channel {}: unit = {}; allowed: {}", file.string(),
                                     channel.code, channel.unit, unit));
}

station::ChannelScale channel_with(const station::Metadata& station, const std::string& ending,
                                   const char* unit, const std::filesystem::path& file) {
    std::vector<std::string> codes;
    for (const station::ChannelScale& channel : station.channels) {
        codes.push_back(channel.code);
        if (channel.code.size() != 3 || channel.code.substr(1) != ending ||
            archive::is_derived(channel.code))
            continue;
        require_unit(channel, unit, file);
        return channel;
    }
    throw InputError(fmt::format("{}: no channel ?{}; there are: {}", file.string(), ending,
                                 text::joined(codes)));
}

}  // namespace

Epoch epoch_of(UtcTime start, const station::Metadata& station, const std::filesystem::path& file) {
    Epoch epoch{start, station.serial_number, station.codes, {}, station.position};
    if (station.noise_ug_per_sqrt_hz)
        epoch.data_sheet_mgal_per_sqrt_hz =
            1e-6 * *station.noise_ug_per_sqrt_hz * kMilliGalPerStandardGravity;
    for (const std::string& axis : station.codes.axes)
        epoch.channels.push_back(channel_with(station, "N" + axis, "m/s**2", file));
    epoch.channels.push_back(channel_with(station, "K1", "degC", file));
    const auto outer = std::ranges::find(station.channels, archive::kOuterTemperature,
                                         &station::ChannelScale::code);
    if (outer != station.channels.end()) {
        require_unit(*outer, "degC", file);
        epoch.channels.push_back(*outer);
    }
    return epoch;
}

std::vector<Epoch> read_epochs(const std::filesystem::path& metadata) {
    std::vector<Epoch> epochs;
    for (const auto& [start, station] : station::read_station_epochs(metadata)) {
        Epoch epoch = epoch_of(start, station, metadata);
        if (epochs.empty() || !epoch_change(epochs.back(), epoch).empty())
            epochs.push_back(std::move(epoch));
        else if (epoch.has_outer())
            epochs.back().channels = std::move(epoch.channels);  // it was installed later
    }
    return epochs;
}

text::Message sensor_change(const std::string& before, const std::string& after) {
    if (before.empty() || after.empty() || before == after) return {};
    return text::message("another sensor: {} after {}", after, before);
}

text::Message epoch_change(const Epoch& before, const Epoch& after) {
    if (text::Message change = sensor_change(before.serial_number, after.serial_number);
        !change.empty())
        return change;
    if (!(before.codes == after.codes)) return text::message("other channels");
    for (std::size_t k = 0; k <= kTemperature; ++k) {
        const station::ChannelScale &a = before.channels[k], &b = after.channels[k];
        if (a.code != b.code) return text::message("other channels");
        if (a.gain != b.gain || a.offset != b.offset)
            return text::message("another scale of {}", b.code);
    }
    return {};
}

}  // namespace a351::corrector::archive_series
