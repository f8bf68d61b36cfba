#include "protocol/station/described_again.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/time_gate.hpp"
#include "protocol/station/session_description.hpp"
#include "protocol/station/station_document.hpp"

namespace a351::station {
namespace {

namespace fs = std::filesystem;

/// Content of a file of metadata that a journal lacks.
class Place {
public:
    explicit Place(const fs::path& file)
        : file_(file),
          document_(load_station_document(file)),
          channels_(document_.select_nodes("/FDSNStationXML/Network/Station/Channel")) {
        for (const auto& channel : channels_)
            begin_ = std::min(begin_, date_of(file_, channel.node(), "startDate").value_or(begin_));
    }

    /// Completes a description with position and ovens at an instant by the clock of the host.  Before
    /// the first epoch they are those of the first one, because the clock was not set.
    void complete(Description& description, UtcTime at) const {
        at = std::max(at, begin_);
        pugi::xml_node place;  // without an epoch at this instant, the first one
        for (const auto& found : channels_) {
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
    pugi::xpath_node_set channels_;
    UtcTime begin_ = UtcTime::max();  ///< Begin of the first epoch.
};

}  // namespace

void describe_again(files::FileLayer& files, const fs::path& from, const fs::path& to,
                    const std::vector<archive::RetimedSegment>& segments) {
    archive::copy_metadata(from, to);
    const fs::path file = to / "metadata" / "station.xml";
    if (!fs::exists(file)) return;
    const Place place(file);
    bool is_first = true;
    for (const auto& [header, start] : segments) {
        if (!start || *start < archive::TimeGate::kEarliest) continue;  // It has no records.
        Description description;
        describe_session(description, header);
        place.complete(description, header.clock.realtime);
        description.start = *start;
        const auto xml = std::exchange(is_first, false) ? to_station_xml(description)
                                                        : extend_station_xml(file, description);
        if (xml) files::replace_file(files, file, std::as_bytes(std::span(*xml)));
    }
}

}  // namespace a351::station
