#include "protocol/station/station_xml.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "protocol/archive/channel_code.hpp"
#include "protocol/station/station_document.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::station {

namespace {

constexpr const char* kAcceleration = "m/s**2";
constexpr const char* kTemperature = "degC";
/// Frequency of the sensitivity, Hz; the response is flat up to the edge of the filter.
constexpr double kReferenceFrequency_hz = 1.0;
/// Rate of a slow channel over the frequency of its sensitivity, which must be below half the rate.
constexpr double kSlowRatePerReferenceFrequency = 10.0;

/// Returns the shortest text that reads back as the same double.
std::string to_text(double value) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// Replaces all characters except printable ASCII: a device may send any byte, and XML 1.0 does not
/// permit control characters.
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

/// Adds a flat response: counts = gain x value in `unit`.
void add_gain_response(pugi::xml_node channel, double gain, const char* unit, double frequency_hz) {
    auto response = channel.append_child("Response");
    auto sensitivity = response.append_child("InstrumentSensitivity");
    add(sensitivity, "Value", gain);
    add(sensitivity, "Frequency", frequency_hz);
    add_units(sensitivity, unit);
    auto stage = response.append_child("Stage");
    stage.append_attribute("number").set_value(1);
    auto flat = stage.append_child("PolesZeros");
    add_units(flat, unit);
    add(flat, "PzTransferFunctionType", "LAPLACE (RADIANS/SECOND)");
    add(flat, "NormalizationFactor", 1.0);
    add(flat, "NormalizationFrequency", frequency_hz);
    auto stage_gain = stage.append_child("StageGain");
    add(stage_gain, "Value", gain);
    add(stage_gain, "Frequency", frequency_hz);
}

/// Adds a polynomial response: value = offset + slope x counts.
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

/// Returns the orientation of a channel by its last letter (SEED reference manual 2.4, appendix A).
Orientation orientation_of(const std::string& suffix) {
    if (suffix == "Z") return {0.0, -90.0, true};
    if (suffix == "N") return {0.0, 0.0, true};
    if (suffix == "E") return {90.0, 0.0, true};
    return {suffix == "2" ? 90.0 : 0.0, 0.0, false};
}

void add_position(pugi::xml_node parent, const Description& description) {
    add(parent, "Latitude", description.latitude.value());
    add(parent, "Longitude", description.longitude.value());
    add(parent, "Elevation", description.elevation.value());
}

/// Adds a channel with the attributes that all channels have; add_place() comes later.
pugi::xml_node add_channel(pugi::xml_node station, const Description& description,
                           std::string_view code) {
    auto channel = station.append_child("Channel");
    channel.append_attribute("code").set_value(std::string(code).c_str());
    channel.append_attribute("locationCode").set_value(description.codes.location.c_str());
    channel.append_attribute("startDate").set_value(to_rfc3339(description.start, 6).c_str());
    return channel;
}

void add_place(pugi::xml_node channel, const Description& description,
               const Orientation& orientation, double rate_hz) {
    add_position(channel, description);
    add(channel, "Depth", 0.0);
    add(channel, "Azimuth", orientation.azimuth_deg);
    add(channel, "Dip", orientation.dip_deg);
    add(channel, "SampleRate", rate_hz);
}

void add_sensor(pugi::xml_node channel, const Description& description) {
    auto sensor = channel.append_child("Sensor");
    add(sensor, "Manufacturer", "Seiko Epson");
    add(sensor, "Model", printable(description.product_id));
    add(sensor, "SerialNumber", printable(description.serial_number));
}

/// Adds a sampled channel, complete except for its response.
pugi::xml_node add_sampled_channel(pugi::xml_node station, const Description& description,
                                   const std::string& instrument_and_axis,
                                   const std::string& content, const Orientation& orientation) {
    const int rate_hz = description.output_rate_hz;
    auto channel =
        add_channel(station, description, archive::channel_code(rate_hz, instrument_and_axis));
    add_comment(channel, content);
    add_comment(channel, fmt::format("{}{} ({})", kProfileComment, description.profile,
                                     description.is_profile_verified ? "verified" : "unverified"));
    add_comment(channel,
                fmt::format("filter {}, group delay {} s, already subtracted from the "
                            "time stamps",
                            description.filter,
                            to_text(static_cast<double>(description.group_delay.count()) / 1e9)));
    add_comment(channel, fmt::format("firmware {}", description.firmware));
    if (description.start_up_test != wire::StartUpTest::passed)
        add_comment(channel, fmt::format("start-up test of the sensor: {}",
                                         wire::to_text(description.start_up_test)));
    if (!orientation.is_known) add_comment(channel, "orientation not surveyed");
    add_place(channel, description, orientation, rate_hz);
    if (const auto declared_hz = description.declared_rate_hz)
        add(channel, "ClockDrift", std::abs(1.0 / *declared_hz - 1.0 / rate_hz));
    add_sensor(channel, description);
    return channel;
}

/// Origin of a derived channel.
enum class Source { sensor, oven, outer_oven, clock };

/// Properties of a derived channel.
struct SlowChannel {
    std::string_view code;
    const char* content;
    const char* unit;
    double counts_per_unit;
    Source source;
};

constexpr SlowChannel kSlowChannels[] = {
    {archive::kSensorTemperature, "sensor temperature, mean over the second", kTemperature, 1000.0,
     Source::sensor},
    {archive::kOvenTemperature, "oven, process value", kTemperature, 1000.0, Source::oven},
    {archive::kOvenSetPoint, "oven, set point", kTemperature, 1000.0, Source::oven},
    {archive::kOvenHeating, "oven, heating", "%", 100.0, Source::oven},
    {archive::kOuterTemperature, "outer oven, process value", kTemperature, 1000.0,
     Source::outer_oven},
    {archive::kOuterSetPoint, "outer oven, set point", kTemperature, 1000.0, Source::outer_oven},
    {archive::kOuterHeating, "outer oven, heating", "%", 100.0, Source::outer_oven},
    {archive::kClockError, "sample times less those by start and rate of a record", "s", 1e6,
     Source::clock},
    {archive::kTimingQuality, "timing quality", "%", 1.0, Source::clock},
};

/// Returns the interval of a source's channels; std::nullopt if the box has no such source.
std::optional<std::chrono::seconds> interval_of(Source source, const Description& description) {
    if (source == Source::oven)
        return description.has_oven ? std::optional(description.oven_interval) : std::nullopt;
    if (source == Source::outer_oven)
        return description.has_outer_oven ? std::optional(description.outer_oven_interval)
                                          : std::nullopt;
    return std::chrono::seconds(1);
}

void add_slow_channel(pugi::xml_node station, const Description& description,
                      const SlowChannel& slow, std::chrono::seconds interval) {
    auto channel = add_channel(station, description, slow.code);
    add_comment(channel, slow.content);
    const double rate_hz = 1.0 / static_cast<double>(interval.count());
    add_place(channel, description, Orientation{}, rate_hz);
    if (slow.source == Source::sensor) add_sensor(channel, description);
    add_gain_response(channel, slow.counts_per_unit, slow.unit,
                      rate_hz / kSlowRatePerReferenceFrequency);
}

}  // namespace

std::string to_station_xml(const Description& description) {
    const auto* profile = wire::find_profile(description.profile);
    if (!profile) {
        throw std::invalid_argument(
            fmt::format("Description: profile = {}: unknown", description.profile));
    }
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    auto root = document.append_child("FDSNStationXML");
    root.append_attribute("xmlns").set_value("http://www.fdsn.org/xml/station/1");
    root.append_attribute("schemaVersion").set_value("1.2");
    add(root, "Source", "a351");
    // The schema requires a time of creation.  The start of the epoch is used, so that the same
    // input gives the same bytes.
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
    // All three channels have this text: if the letters change, all three begin a new epoch, so
    // their order stays that of the axes.
    const auto& axes = description.codes.axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::string content =
            fmt::format("axis {}; x, y, z are {}, {}, {}", "xyz"[i], axes[0], axes[1], axes[2]);
        add_gain_response(add_sampled_channel(station, description, "N" + axes[i], content,
                                              orientation_of(axes[i])),
                          gain, kAcceleration, kReferenceFrequency_hz);
    }
    auto response =
        add_sampled_channel(station, description, "K1", "sensor temperature", Orientation{})
            .append_child("Response");
    const double offset_degc = profile->temperature_offset_degc;
    const double slope_degc = profile->temperature_slope_degc;
    add_polynomial(response.append_child("InstrumentPolynomial"), offset_degc, slope_degc,
                   description.output_rate_hz);
    auto stage = response.append_child("Stage");
    stage.append_attribute("number").set_value(1);
    add_polynomial(stage.append_child("Polynomial"), offset_degc, slope_degc,
                   description.output_rate_hz);
    for (const SlowChannel& slow : kSlowChannels)
        if (const auto interval = interval_of(slow.source, description))
            add_slow_channel(station, description, slow, *interval);
    return xml_text(document);
}

std::string xml_text(const pugi::xml_document& document) {
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

}  // namespace a351::station
