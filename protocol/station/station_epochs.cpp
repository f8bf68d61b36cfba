#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include "protocol/station/station_document.hpp"

namespace a351::station {
namespace {

pugi::xml_node with_code(pugi::xml_node parent, const char* name, const char* code) {
    return parent.find_child_by_attribute(name, "code", code);
}

/// Returns the content of an epoch without its dates.
std::string content_of(pugi::xml_node channel) {
    pugi::xml_document copy;
    auto node = copy.append_copy(channel);
    node.remove_attribute("startDate");
    node.remove_attribute("endDate");
    std::ostringstream text;
    copy.print(text, "", pugi::format_raw);
    return text.str();
}

/// Returns an element of the position.  One that a file of another program lacks is added, before
/// Site as in the schema.
pugi::xml_node child_in_order(pugi::xml_node station, const std::string& name) {
    constexpr std::array kOrder{"Latitude", "Longitude", "Elevation", "Site", "Channel"};
    if (const auto child = station.child(name.c_str())) return child;
    for (auto next = std::ranges::find(kOrder, name); next != kOrder.end(); ++next)
        if (const auto later = station.child(*next))
            return station.insert_child_before(name.c_str(), later);
    return station.append_child(name.c_str());
}

void set_date(pugi::xml_node node, const char* name, UtcTime date) {
    auto attribute = node.attribute(name);
    if (!attribute) attribute = node.append_attribute(name);
    attribute.set_value(to_rfc3339(date, 6).c_str());
}

/// Extends a document: unchanged channels continue, others end at `start`, and new ones begin.
class Extension {
public:
    Extension(const std::filesystem::path& file, UtcTime start) : file_(file), start_(start) {}

    [[nodiscard]] bool has_changed() const noexcept { return has_changed_; }

    void extend(pugi::xml_node station, pugi::xml_node fresh) {
        for (const char* name : {"Latitude", "Longitude", "Elevation"}) {
            const char* value = fresh.child_value(name);
            if (value == std::string(station.child_value(name))) continue;
            child_in_order(station, name).text().set(value);
            has_changed_ = true;
        }
        cover_start(station);
        for (const auto channel : fresh.children("Channel")) {
            if (!continues(station, channel)) add(station, channel);
        }
    }

    /// Ends the open epochs of a station that the fresh one does not have.
    void end_others(pugi::xml_node station, pugi::xml_node fresh) {
        for (auto channel : station.children("Channel")) {
            if (channel.attribute("endDate") || (fresh && is_among(fresh, channel))) continue;
            const auto begun = date_of(file_, channel, "startDate").value_or(start_);
            set_date(channel, "endDate", std::max(begun, start_));  // a clock may have been ahead
            has_changed_ = true;
        }
    }

    void add(pugi::xml_node parent, pugi::xml_node fresh) {
        parent.append_copy(fresh);
        has_changed_ = true;
    }

private:
    static bool is_among(pugi::xml_node fresh, pugi::xml_node channel) {
        const auto channels = fresh.children("Channel");
        return std::any_of(channels.begin(), channels.end(),
                           [&](const auto& one) { return content_of(one) == content_of(channel); });
    }

    bool continues(pugi::xml_node station, pugi::xml_node fresh) {
        for (auto channel : station.children("Channel")) {
            if (channel.attribute("endDate") || content_of(channel) != content_of(fresh)) continue;
            cover_start(channel);
            return true;
        }
        return false;
    }

    /// Moves the start date back to `start`: the host's clock may have been ahead at that time.
    void cover_start(pugi::xml_node node) {
        if (date_of(file_, node, "startDate").value_or(start_) <= start_) return;
        set_date(node, "startDate", start_);
        has_changed_ = true;
    }

    const std::filesystem::path& file_;
    UtcTime start_;
    bool has_changed_ = false;
};

}  // namespace

std::optional<std::string> extend_station_xml(const std::filesystem::path& file,
                                              const Description& description) {
    auto document = load_station_document(file);
    auto root = document.child("FDSNStationXML");
    pugi::xml_document fresh;  // read like a file, where an empty text is absent
    fresh.load_string(to_station_xml(description).c_str());
    const auto fresh_network = fresh.child("FDSNStationXML").child("Network");
    const auto fresh_station = fresh_network.child("Station");
    auto network = with_code(root, "Network", description.codes.network.c_str());
    auto station = with_code(network, "Station", description.codes.station.c_str());

    Extension extension(file, description.start);
    for (const auto each : root.children("Network")) {
        for (const auto other : each.children("Station"))
            extension.end_others(other, other == station ? fresh_station : pugi::xml_node());
    }
    if (station)
        extension.extend(station, fresh_station);
    else if (network)
        extension.add(network, fresh_station);
    else
        extension.add(root, fresh_network);
    if (!extension.has_changed()) return std::nullopt;
    root.child("Created").text().set(to_rfc3339(description.start, 6).c_str());
    return xml_text(document);
}

}  // namespace a351::station
