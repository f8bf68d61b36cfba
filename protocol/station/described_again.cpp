#include "protocol/station/described_again.hpp"

#include <span>
#include <string_view>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/archive/time_gate.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/station/station_document.hpp"

namespace a351::station {
namespace {

namespace fs = std::filesystem;

/// Content of a file of metadata that a journal lacks.
class Place {
public:
    explicit Place(const fs::path& file) : file_(file), document_(load_station_document(file)) {}

    /// Completes a description with position and ovens at an instant.
    void complete(Description& description, UtcTime at) const {
        pugi::xml_node place;  // without an epoch at this instant, the first one
        for (const auto& found :
             document_.select_nodes("/FDSNStationXML/Network/Station/Channel")) {
            const auto channel = found.node();
            const bool is_now = is_in_force(file_, channel, at);
            if (is_now || !place) place = channel;
            const std::string_view code = channel.attribute("code").value();
            description.has_oven |= is_now && code == archive::kOvenTemperature;
            description.has_outer_oven |= is_now && code == archive::kOuterTemperature;
        }
        description.latitude = Degrees(place.child("Latitude").text().as_double());
        description.longitude = Degrees(place.child("Longitude").text().as_double());
        description.elevation = Metres(place.child("Elevation").text().as_double());
    }

private:
    fs::path file_;
    pugi::xml_document document_;
};

Description description_of(const journal::Header& header, const wire::DeviceProfile& profile) {
    Description description;
    description.codes = header.codes;
    description.profile = profile.name;
    description.is_profile_verified = profile.is_verified;
    description.product_id = header.product_id;
    description.serial_number = header.serial_number;
    description.start_up_test = header.start_up_test;
    description.firmware = header.firmware;
    description.output_rate_hz = header.output_rate_hz;
    description.filter = header.filter;
    if (const auto* const filter = profile.filter_named(header.filter))
        description.group_delay = profile.group_delay(*filter);
    description.declared_rate_hz = header.declared_rate_hz;
    description.oven_interval = header.oven_interval;
    description.outer_oven_interval = header.outer_oven_interval;
    // The times of the first samples precede their header by the filter's delay.
    description.start = header.clock.realtime - description.group_delay;
    return description;
}

}  // namespace

void describe_again(files::FileLayer& files, const fs::path& from, const fs::path& to,
                    const wire::DeviceProfile& profile) {
    archive::copy_metadata(from, to);
    const fs::path file = to / "metadata" / "station.xml";
    if (!fs::exists(file)) return;
    const Place place(file);
    fs::remove(file);
    for (const auto& segment : journal::segment_files(from / "journal")) {
        const auto header = journal::segment_header(segment);
        // Without a host clock the start of an epoch is not known.
        if (!header || header->clock.realtime < archive::TimeGate::kEarliest) continue;
        Description description = description_of(archive::recorded_with(profile, *header), profile);
        place.complete(description, header->clock.realtime);
        const auto xml =
            fs::exists(file) ? extend_station_xml(file, description) : to_station_xml(description);
        if (xml) files::replace_file(files, file, std::as_bytes(std::span(*xml)));
    }
}

}  // namespace a351::station
