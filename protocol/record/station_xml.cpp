#include "protocol/record/station_xml.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "protocol/core/input_error.hpp"
#include "protocol/record/channel_code.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::record {

namespace {

constexpr const char* kAcceleration = "m/s**2";
constexpr const char* kTemperature = "degC";
/// The sensitivity is stated at this frequency; the response is flat up to the filter's edge.
constexpr double kReferenceFrequency_hz = 1.0;

std::string to_text(double value) {
    std::array<char, 32> buffer{};
    // The shortest text that reads back as the same double.
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end.ptr};
}

/// Device strings come off a wire; XML 1.0 has no place for control characters.
std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

void add(pugi::xml_node parent, const char* name, const std::string& text) {
    parent.append_child(name).text().set(text.c_str());
}

void add(pugi::xml_node parent, const char* name, double value) {
    add(parent, name, to_text(value));
}

void add_comment(pugi::xml_node parent, const std::string& text) {
    add(parent.append_child("Comment"), "Value", text);
}

void add_units(pugi::xml_node parent, const char* input) {
    add(parent.append_child("InputUnits"), "Name", input);
    add(parent.append_child("OutputUnits"), "Name", "count");
}

/// counts = gain x acceleration in m/s2
void add_gain_response(pugi::xml_node channel, double gain) {
    auto response = channel.append_child("Response");
    auto sensitivity = response.append_child("InstrumentSensitivity");
    add(sensitivity, "Value", gain);
    add(sensitivity, "Frequency", kReferenceFrequency_hz);
    add_units(sensitivity, kAcceleration);
    auto stage = response.append_child("Stage");
    stage.append_attribute("number").set_value(1);
    auto flat = stage.append_child("PolesZeros");
    add_units(flat, kAcceleration);
    add(flat, "PzTransferFunctionType", "LAPLACE (RADIANS/SECOND)");
    add(flat, "NormalizationFactor", 1.0);
    add(flat, "NormalizationFrequency", kReferenceFrequency_hz);
    auto stage_gain = stage.append_child("StageGain");
    add(stage_gain, "Value", gain);
    add(stage_gain, "Frequency", kReferenceFrequency_hz);
}

/// value = offset + slope x counts
void add_polynomial(pugi::xml_node polynomial, double offset, double slope, double rate_hz) {
    add_units(polynomial, kTemperature);
    add(polynomial, "ApproximationType", "MACLAURIN");
    add(polynomial, "FrequencyLowerBound", 0.0);
    add(polynomial, "FrequencyUpperBound", rate_hz / 2.0);
    add(polynomial, "ApproximationLowerBound", double{std::numeric_limits<std::int32_t>::min()});
    add(polynomial, "ApproximationUpperBound", double{std::numeric_limits<std::int32_t>::max()});
    add(polynomial, "MaximumError", 0.0);
    int number = 1;
    for (const double value : {offset, slope}) {
        auto coefficient = polynomial.append_child("Coefficient");
        coefficient.append_attribute("number").set_value(number++);
        coefficient.text().set(to_text(value).c_str());
    }
}

struct Orientation {
    double azimuth_deg = 0.0;
    double dip_deg = 0.0;
    bool is_known = true;
};

/// By the channel's last letter (SEED reference manual 2.4, appendix A).
Orientation orientation_of(const std::string& suffix) {
    if (suffix == "Z") return {0.0, -90.0, true};
    if (suffix == "N") return {0.0, 0.0, true};
    if (suffix == "E") return {90.0, 0.0, true};
    return {suffix == "2" ? 90.0 : 0.0, 0.0, false};
}

void add_position(pugi::xml_node parent, const StationDescription& description) {
    add(parent, "Latitude", description.latitude.value());
    add(parent, "Longitude", description.longitude.value());
    add(parent, "Elevation", description.elevation.value());
}

/// What every channel says, up to its response.
pugi::xml_node add_channel(pugi::xml_node station, const StationDescription& description,
                           const std::string& code, const Orientation& orientation) {
    auto channel = station.append_child("Channel");
    channel.append_attribute("code").set_value(code.c_str());
    channel.append_attribute("locationCode").set_value(description.codes.location.c_str());
    channel.append_attribute("startDate").set_value(to_rfc3339(description.start, 6).c_str());
    add_comment(channel, "device profile " + description.profile +
                             (description.is_profile_verified ? " (verified)" : " (unverified)"));
    add_comment(channel, "filter " + description.filter + ", group delay " +
                             to_text(static_cast<double>(description.group_delay.count()) / 1e9) +
                             " s, already subtracted from the time stamps");
    add_comment(channel, "firmware " + std::to_string(description.firmware));
    if (!orientation.is_known) add_comment(channel, "orientation not surveyed");
    add_position(channel, description);
    add(channel, "Depth", 0.0);
    add(channel, "Azimuth", orientation.azimuth_deg);
    add(channel, "Dip", orientation.dip_deg);
    add(channel, "SampleRate", double(description.output_rate_hz));
    auto sensor = channel.append_child("Sensor");
    add(sensor, "Manufacturer", "Seiko Epson");
    add(sensor, "Model", printable(description.product_id));
    add(sensor, "SerialNumber", printable(description.serial_number));
    return channel;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& trouble) {
    throw InputError(file.string() + ": " + trouble);
}

double number_in(const std::filesystem::path& file, const std::string& channel,
                 pugi::xml_node node) {
    const std::string_view text = node.text().get();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        refuse(file, "channel " + channel + ": " + node.name() + " = " + std::string(text) +
                         ": not a number");
    }
    return value;
}

ChannelScale read_scale(const std::filesystem::path& file, pugi::xml_node channel) {
    ChannelScale scale;
    scale.code = channel.attribute("code").value();
    const auto response = channel.child("Response");
    const auto sensitivity = response.child("InstrumentSensitivity");
    const auto polynomial = response.child("InstrumentPolynomial");
    const auto described = sensitivity ? sensitivity : polynomial;
    scale.unit = described.child("InputUnits").child("Name").text().get();
    if (scale.unit.empty()) refuse(file, "channel " + scale.code + ": no response with a unit");
    if (sensitivity) {
        const double gain = number_in(file, scale.code, sensitivity.child("Value"));
        if (!(gain > 0.0)) refuse(file, "channel " + scale.code + ": sensitivity must be > 0");
        scale.gain = 1.0 / gain;
        return scale;
    }
    std::vector<double> coefficients;
    for (const auto node : polynomial.children("Coefficient")) {
        coefficients.push_back(number_in(file, scale.code, node));
    }
    if (coefficients.size() != 2) {
        refuse(file, "channel " + scale.code + ": " + std::to_string(coefficients.size()) +
                         " polynomial coefficients; allowed: 2");
    }
    scale.offset = coefficients[0];
    scale.gain = coefficients[1];
    return scale;
}

}  // namespace

std::string to_station_xml(const StationDescription& description) {
    const auto* profile = wire::find_profile(description.profile);
    if (!profile) {
        throw std::invalid_argument("StationDescription: profile = " + description.profile +
                                    ": unknown");
    }
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    auto root = document.append_child("FDSNStationXML");
    root.append_attribute("xmlns").set_value("http://www.fdsn.org/xml/station/1");
    root.append_attribute("schemaVersion").set_value("1.2");
    add(root, "Source", "a351");
    // The schema demands an instant of creation; that of the epoch keeps the same input at the
    // same bytes.
    add(root, "Created", to_rfc3339(description.start, 6));
    auto network = root.append_child("Network");
    network.append_attribute("code").set_value(description.codes.network.c_str());
    auto station = network.append_child("Station");
    station.append_attribute("code").set_value(description.codes.station.c_str());
    station.append_attribute("startDate").set_value(to_rfc3339(description.start, 6).c_str());
    add_position(station, description);
    add(station.append_child("Site"), "Name", description.codes.station);

    // Counts per g over m/s2 per g.
    const double gain =
        std::ldexp(1.0, profile->acceleration_fraction_bits) / (kMilliGalPerStandardGravity / 1e5);
    for (const std::string& axis : description.codes.axes) {
        add_gain_response(
            add_channel(station, description, channel_code(description.output_rate_hz, "N" + axis),
                        orientation_of(axis)),
            gain);
    }
    auto response = add_channel(station, description,
                                channel_code(description.output_rate_hz, "K1"), Orientation{})
                        .append_child("Response");
    const double offset_degc = profile->temperature_offset_degc;
    const double slope_degc = profile->temperature_slope_degc;
    add_polynomial(response.append_child("InstrumentPolynomial"), offset_degc, slope_degc,
                   description.output_rate_hz);
    auto stage = response.append_child("Stage");
    stage.append_attribute("number").set_value(1);
    add_polynomial(stage.append_child("Polynomial"), offset_degc, slope_degc,
                   description.output_rate_hz);
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

StationMetadata read_station_xml(const std::filesystem::path& file) {
    pugi::xml_document document;
    const auto result = document.load_file(file.c_str());
    if (!result) refuse(file, std::string("cannot be read as XML: ") + result.description());
    const auto network = document.child("FDSNStationXML").child("Network");
    const auto station = network.child("Station");
    if (!station) refuse(file, "not StationXML: no FDSNStationXML/Network/Station");
    StationMetadata metadata;
    metadata.codes.network = network.attribute("code").value();
    metadata.codes.station = station.attribute("code").value();
    std::vector<std::string> axes;
    for (const auto channel : station.children("Channel")) {
        auto scale = read_scale(file, channel);
        metadata.codes.location = channel.attribute("locationCode").value();
        // Epochs follow each other: the last one of a channel counts.
        const auto known = std::find_if(metadata.channels.begin(), metadata.channels.end(),
                                        [&](const auto& one) { return one.code == scale.code; });
        if (known != metadata.channels.end()) {
            *known = std::move(scale);
            continue;
        }
        if (scale.code.size() == 3 && scale.code[1] == 'N') axes.push_back(scale.code.substr(2));
        metadata.channels.push_back(std::move(scale));
    }
    if (axes.size() != metadata.codes.axes.size()) {
        refuse(file, std::to_string(axes.size()) + " acceleration channels; allowed: 3");
    }
    std::copy(axes.begin(), axes.end(), metadata.codes.axes.begin());
    return metadata;
}

}  // namespace a351::record
