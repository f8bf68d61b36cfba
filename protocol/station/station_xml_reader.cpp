#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "protocol/core/input_error.hpp"
#include "protocol/station/station_document.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::station {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& trouble) {
    throw InputError(file.string() + ": " + trouble);
}

double number_in(const std::filesystem::path& file, const std::string& channel,
                 pugi::xml_node node) {
    const std::string_view text = node.text().get();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        refuse(file, fmt::format("channel {}: {} = {}: not a number", channel, node.name(), text));
    }
    return value;
}

/// Returns the unit as this project writes it.  SEED writes capital letters; other programs write the
/// power in other ways.
std::string usual_unit(std::string_view name) {
    std::string lower(name);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c | 0x20);
    if (lower == "m/s**2" || lower == "m/s^2" || lower == "m/s/s" || lower == "m/s2")
        return "m/s**2";
    return lower == "degc" ? "degC" : lower == "s" ? "s" : std::string(name);
}

/// Takes the prefix of a namespace from the names of all elements below a node.
void remove_prefix(pugi::xml_node node, const std::string& prefix) {
    for (pugi::xml_node child : node.children()) {
        const std::string_view name = child.name();
        if (name.starts_with(prefix))
            child.set_name(std::string(name.substr(prefix.size())).c_str());
        remove_prefix(child, prefix);
    }
}

/// Gives elements with the prefix of the root, as in <fsx:FDSNStationXML>, their usual names.
void remove_prefix_of_root(pugi::xml_document& document) {
    const std::string name = document.document_element().name();
    const std::size_t colon = name.find(':');
    if (colon == std::string::npos) return;
    document.document_element()
        .attribute(("xmlns:" + name.substr(0, colon)).c_str())
        .set_name("xmlns");
    remove_prefix(document, name.substr(0, colon + 1));
}

ChannelScale read_scale(const std::filesystem::path& file, pugi::xml_node channel) {
    ChannelScale scale;
    scale.code = channel.attribute("code").value();
    if (const auto dip = channel.child("Dip")) scale.dip_deg = dip.text().as_double();
    if (const auto rate = channel.child("SampleRate")) {
        const double rate_hz = number_in(file, scale.code, rate);
        if (rate_hz > 0.0) scale.rate_hz = rate_hz;  // 0 is a channel without a steady rate
    }
    const auto response = channel.child("Response");
    const auto sensitivity = response.child("InstrumentSensitivity");
    const auto polynomial = response.child("InstrumentPolynomial");
    const auto described = sensitivity ? sensitivity : polynomial;
    scale.unit = usual_unit(described.child("InputUnits").child("Name").text().get());
    if (scale.unit.empty()) refuse(file, "channel " + scale.code + ": no response with a unit");
    if (sensitivity) {
        const double gain = number_in(file, scale.code, sensitivity.child("Value"));
        if (!(gain > 0.0)) refuse(file, "channel " + scale.code + ": sensitivity must be > 0");
        scale.gain = 1.0 / gain;
        return scale;
    }
    std::vector<double> coefficients;
    for (const auto node : polynomial.children("Coefficient"))
        coefficients.push_back(number_in(file, scale.code, node));
    if (coefficients.size() != 2) {
        refuse(file, fmt::format("channel {}: {} polynomial coefficients; allowed: 2", scale.code,
                                 coefficients.size()));
    }
    scale.offset = coefficients[0];
    scale.gain = coefficients[1];
    return scale;
}

std::optional<Position> position_of(pugi::xml_node station) {
    if (!station.child("Latitude") || !station.child("Longitude")) return std::nullopt;
    return Position{Degrees(station.child("Latitude").text().as_double()),
                    Degrees(station.child("Longitude").text().as_double()),
                    Metres(station.child("Elevation").text().as_double())};
}

/// Returns the noise by the profile that a comment of a channel names.
std::optional<double> noise_of(pugi::xml_node channel) {
    const std::string_view begin = kProfileComment;
    for (const auto comment : channel.children("Comment")) {
        const std::string_view text = comment.child("Value").text().get();
        if (!text.starts_with(begin)) continue;
        const std::string_view name = text.substr(begin.size());
        const auto* const profile = wire::find_profile(name.substr(0, name.find(' ')));
        if (profile != nullptr) return profile->noise_ug_per_sqrt_hz;
    }
    return std::nullopt;
}

Metadata channels_in_force(const std::filesystem::path& file, const pugi::xml_document& document,
                           std::optional<UtcTime> at) {
    Metadata metadata;
    for (const auto network : document.child("FDSNStationXML").children("Network")) {
        for (const auto station : network.children("Station")) {
            for (const auto channel : station.children("Channel")) {
                if (!is_in_force(file, channel, at)) continue;
                metadata.codes.network = network.attribute("code").value();
                metadata.codes.station = station.attribute("code").value();
                metadata.codes.location = channel.attribute("locationCode").value();
                if (metadata.serial_number.empty())
                    metadata.serial_number =
                        channel.child("Sensor").child("SerialNumber").text().get();
                if (!metadata.noise_ug_per_sqrt_hz)
                    metadata.noise_ug_per_sqrt_hz = noise_of(channel);
                auto scale = read_scale(file, channel);
                // After a clock was set back, epochs may overlap: the later one counts.
                const auto known =
                    std::ranges::find(metadata.channels, scale.code, &ChannelScale::code);
                if (known != metadata.channels.end())
                    *known = std::move(scale);
                else
                    metadata.channels.push_back(std::move(scale));
            }
            if (metadata.channels.empty()) continue;
            metadata.position = position_of(station);
            return metadata;
        }
    }
    return metadata;
}

Metadata metadata_at(const std::filesystem::path& file, const pugi::xml_document& document,
                     std::optional<UtcTime> at) {
    Metadata metadata = channels_in_force(file, document, at);
    if (at && metadata.channels.empty()) metadata = channels_in_force(file, document, {});
    std::vector<std::string> axes;
    for (const ChannelScale& channel : metadata.channels)
        if (channel.code.size() == 3 && channel.code[1] == 'N')
            axes.push_back(channel.code.substr(2));
    if (axes.size() != metadata.codes.axes.size()) {
        refuse(file, fmt::format("{} acceleration channels; allowed: 3", axes.size()));
    }
    std::ranges::copy(axes, metadata.codes.axes.begin());
    return metadata;
}

}  // namespace

std::optional<UtcTime> date_of(const std::filesystem::path& file, pugi::xml_node node,
                               const char* attribute) {
    const std::string text = node.attribute(attribute).value();
    // Open epochs often end at 2599-12-31T23:59:59, later than an UtcTime can be.
    int year = 0;
    constexpr int kLastYear = 2261;
    const auto end_of_year = std::from_chars(text.data(), text.data() + text.size(), year).ptr;
    const bool is_open =
        std::string_view(attribute) == "endDate" && *end_of_year == '-' && year > kLastYear;
    if (text.empty() || is_open) return std::nullopt;
    // Dates of StationXML (xs:dateTime) are UTC if they have no zone.
    const auto date = parse_rfc3339_in_zone(text, std::chrono::minutes(0));
    if (!date) {
        refuse(file, fmt::format("{} {}: {} = {}: not an instant", node.name(),
                                 node.attribute("code").value(), attribute, text));
    }
    return date;
}

bool is_in_force(const std::filesystem::path& file, pugi::xml_node channel,
                 std::optional<UtcTime> at) {
    const auto end = date_of(file, channel, "endDate");
    if (!at) return !end;
    return date_of(file, channel, "startDate").value_or(UtcTime::min()) <= *at &&
           *at < end.value_or(UtcTime::max());
}

pugi::xml_document load_station_document(const std::filesystem::path& file) {
    pugi::xml_document document;
    const auto result = document.load_file(file.c_str());
    if (!result) refuse(file, std::string("cannot be read as XML: ") + result.description());
    remove_prefix_of_root(document);
    if (!document.child("FDSNStationXML").child("Network").child("Station"))
        refuse(file, "not StationXML: no FDSNStationXML/Network/Station");
    for (const auto network : document.child("FDSNStationXML").children("Network")) {
        for (const auto station : network.children("Station")) {
            for (const auto channel : station.children("Channel")) {
                static_cast<void>(read_scale(file, channel));
                static_cast<void>(date_of(file, channel, "startDate"));
                static_cast<void>(date_of(file, channel, "endDate"));
            }
        }
    }
    return document;
}

Metadata read_station_xml(const std::filesystem::path& file, std::optional<UtcTime> at) {
    return metadata_at(file, load_station_document(file), at);
}

std::map<UtcTime, Metadata> read_station_epochs(const std::filesystem::path& file) {
    const auto document = load_station_document(file);
    std::map<UtcTime, Metadata> epochs;
    for (const auto& found : document.select_nodes("/FDSNStationXML/Network/Station/Channel")) {
        const auto start = date_of(file, found.node(), "startDate").value_or(UtcTime::min());
        if (!epochs.contains(start)) epochs.emplace(start, metadata_at(file, document, start));
    }
    return epochs;
}

}  // namespace a351::station
