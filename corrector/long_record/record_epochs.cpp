#include "corrector/long_record/record_epochs.hpp"

#include <set>

#include "corrector/reading/occupation_window.hpp"
#include "protocol/station/station_document.hpp"

namespace a351::corrector::long_record {

std::vector<RecordEpoch> read_record_epochs(const std::filesystem::path& metadata) {
    const auto document = station::load_station_document(metadata);
    std::set<UtcTime> starts;
    for (const auto& found : document.select_nodes("/FDSNStationXML/Network/Station/Channel"))
        starts.insert(
            station::date_of(metadata, found.node(), "startDate").value_or(UtcTime::min()));
    std::vector<RecordEpoch> epochs;
    for (const UtcTime start : starts) {
        const station::Metadata station = station::read_station_xml(metadata, start);
        const reading::SurveyChannels found = reading::find_channels(station, metadata);
        RecordEpoch epoch{start,
                          station.serial_number,
                          station.codes,
                          {found.axes[0], found.axes[1], found.axes[2], found.temperature},
                          found.outer};
        if (epochs.empty() || !epoch_change(epochs.back(), epoch).empty())
            epochs.push_back(std::move(epoch));
        else if (found.outer)
            epochs.back().outer = found.outer;  // it was installed later
    }
    return epochs;
}

text::Message sensor_change(const std::string& before, const std::string& after) {
    if (before.empty() || after.empty() || before == after) return {};
    return text::message("another sensor: {} after {}", after, before);
}

text::Message epoch_change(const RecordEpoch& before, const RecordEpoch& after) {
    if (text::Message change = sensor_change(before.serial_number, after.serial_number);
        !change.empty())
        return change;
    if (!(before.codes == after.codes)) return text::message("other channels");
    for (std::size_t k = 0; k < kRecordChannels; ++k) {
        const station::ChannelScale &a = before.scales.at(k), &b = after.scales.at(k);
        if (a.code != b.code) return text::message("other channels");
        if (a.gain != b.gain || a.offset != b.offset)
            return text::message("another scale of {}", b.code);
    }
    return {};
}

}  // namespace a351::corrector::long_record
