#include "daemon/config/config.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "daemon/config/unit_thresholds.hpp"
#include "daemon/config/verdict_config.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::daemon {
namespace {

using text::TomlTable;

bool is_code(std::string_view text, std::size_t shortest, std::size_t longest) {
    return text.size() >= shortest && text.size() <= longest &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

std::string code_or_refuse(TomlTable& table, std::string_view key, const char* fallback,
                           std::size_t shortest, std::size_t longest, std::string_view allowed) {
    std::string code = table.string_or(key, fallback);
    if (!is_code(code, shortest, longest)) table.refuse(key, "not a SEED code", allowed);
    return code;
}

double required_number(TomlTable& table, std::string_view key, double low, double high,
                       std::string_view allowed) {
    const auto value = table.number(key, low, high);
    if (!value) table.refuse(key, "missing", allowed);
    return *value;
}

std::array<std::string, 3> read_axes(TomlTable& table, const std::string& joined) {
    std::array<std::string, 3> axes;
    const bool has_form = joined.size() == 5 && joined[1] == ',' && joined[3] == ',';
    if (has_form) axes = {joined.substr(0, 1), joined.substr(2, 1), joined.substr(4, 1)};
    const std::set<std::string> distinct(axes.begin(), axes.end());
    const bool are_codes = std::all_of(axes.begin(), axes.end(),
                                       [](const std::string& axis) { return is_code(axis, 1, 1); });
    if (!are_codes || distinct.size() != axes.size()) {
        table.refuse("axes", "not three channel suffixes",
                     "three different characters A-Z 0-9 for x, y, z, as \"1,2,Z\"");
    }
    return axes;
}

StationConfig read_station(TomlTable table) {
    StationConfig station;
    station.codes.network =
        code_or_refuse(table, "network", "XX", 1, 2, "1 to 2 characters A-Z 0-9");
    station.codes.station =
        code_or_refuse(table, "station", "A351", 1, 5, "1 to 5 characters A-Z 0-9");
    station.codes.location = table.string_or("location", "00");
    if (!station.codes.location.empty() && !is_code(station.codes.location, 2, 2)) {
        table.refuse("location", "not a SEED code", "2 characters A-Z 0-9, or empty");
    }
    station.latitude =
        Degrees(required_number(table, "latitude", -90, 90, "degrees north, -90 to 90"));
    station.longitude =
        Degrees(required_number(table, "longitude", -180, 360, "degrees east, -180 to 360"));
    station.elevation =
        Metres(required_number(table, "elevation_m", -500, 9000, "metres above sea, -500 to 9000"));
    table.require_all_read();
    return station;
}

std::string joined(const auto& values, const auto& text_of) {
    std::string list;
    for (const auto& value : values) list += (list.empty() ? "" : ", ") + text_of(value);
    return list;
}

int coded_value(TomlTable& table, std::string_view key, int fallback,
                std::span<const wire::Coded> choices) {
    const auto value = static_cast<int>(table.integer_or(key, fallback, 0, 10'000'000));
    const bool is_known =
        std::any_of(choices.begin(), choices.end(),
                    [value](const wire::Coded& choice) { return choice.value == value; });
    if (!is_known) {
        table.refuse(key, "not a known value", joined(choices, [](const wire::Coded& choice) {
                         return std::to_string(choice.value);
                     }));
    }
    return value;
}

PortAddress read_address(TomlTable& table) {
    PortAddress address;
    address.path = table.path_or_empty("port");
    const std::string usb = table.string_or("usb", "");
    if (!usb.empty()) {
        address.usb = parse_usb_address(usb);
        if (!address.usb) {
            table.refuse("usb", "not an adapter's address",
                         "VID:PID:SERIAL as printed by a351d --list-ports");
        }
    }
    if (address.path.empty() == !address.usb) {
        table.refuse("port",
                     address.usb ? "given together with usb" : "port and usb are both missing",
                     "exactly one of port and usb");
    }
    return address;
}

void read_filter(TomlTable& table, SensorConfig& sensor) {
    const int rate_hz = sensor.settings.output_rate_hz;
    sensor.filter = table.string_or("filter", "k512_fc9");
    const wire::FilterSpec* const filter = sensor.profile->filter_named(sensor.filter);
    const auto rates = filter == nullptr ? std::span<const int>() : filter->allowed_rates_hz;
    if (std::find(rates.begin(), rates.end(), rate_hz) == rates.end()) {
        table.refuse("filter",
                     "not usable at " + std::to_string(rate_hz) + " Hz with profile " +
                         std::string(sensor.profile->name),
                     joined(sensor.profile->filters_allowed_at(rate_hz),
                            [](std::string_view name) { return std::string(name); }));
    }
    sensor.settings.filter_code = filter->code;
}

SensorConfig read_sensor(TomlTable table, record::StationCodes& codes) {
    SensorConfig sensor;
    sensor.address = read_address(table);
    std::vector<std::string> profiles;
    for (const auto& profile : wire::all_profiles()) profiles.emplace_back(profile.name);
    sensor.profile = wire::find_profile(table.choice_or("profile", "A351", profiles));

    sensor.baud = coded_value(table, "baud", 460800, sensor.profile->baud_rates);
    sensor.settings.output_rate_hz =
        coded_value(table, "output_rate_hz", 50, sensor.profile->output_rates_hz);
    read_filter(table, sensor);

    constexpr int kBitsPerByte = 10;  // 8N1: start bit, eight data bits, stop bit.
    const int needed = sensor.settings.output_rate_hz *
                       static_cast<int>(sensor.settings.layout.frame_size()) * kBitsPerByte;
    if (needed > sensor.baud) {
        table.refuse("baud", "too slow for the output rate",
                     "at least " + std::to_string(needed) + " bit/s");
    }
    sensor.serial_number = table.string_or("serial_number", "");
    codes.axes = read_axes(table, table.string_or("axes", "1,2,Z"));
    table.require_all_read();
    return sensor;
}

/// Compares two paths; existing links are followed.
bool is_same_port(const std::filesystem::path& one, const std::filesystem::path& other) {
    const auto resolved = [](const std::filesystem::path& port) {
        std::error_code error;
        const auto device = std::filesystem::weakly_canonical(port, error);
        return error ? port.lexically_normal() : device;
    };
    return resolved(one) == resolved(other);
}

/// Reads [oven].  The table is also checked if it is not enabled.
std::optional<OvenLinkOptions> read_oven(TomlTable table, const PortAddress& sensor) {
    // Rates that libmodbus can set and a line of 500 m can carry; controllers support some of them.
    constexpr std::array<std::int64_t, 8> kBauds{1200,  2400,  4800,  9600,
                                                 19200, 38400, 57600, 115200};
    const bool is_enabled = table.boolean_or("enabled", false);
    OvenLinkOptions oven;
    oven.line.port = table.path_or_empty("port");
    oven.line.baud = static_cast<int>(table.integer_or("baud", 9600, 1200, 115200));
    if (std::find(kBauds.begin(), kBauds.end(), oven.line.baud) == kBauds.end()) {
        table.refuse("baud", "not a known value",
                     joined(kBauds, [](std::int64_t baud) { return std::to_string(baud); }));
    }
    oven.line.parity = table.choice_or("parity", "E", {"E", "O", "N"}).front();
    // 1 ... 99 by H175-E1, section 1; 0 would address all units.
    oven.line.unit = static_cast<int>(table.integer_or("unit", 1, 1, 99));
    oven.line.is_rs485 = table.boolean_or("rs485", false);
    oven.poll_interval = from_seconds(table.number_or("poll_s", 1.0, 0.1, 3600.0));
    oven.decimals = static_cast<int>(table.integer_or("decimals", 1, 0, oven::kMostDecimals));
    if (is_enabled && oven.line.port.empty()) {
        table.refuse("port", "missing", "the controller's serial port");
    }
    if (is_enabled && !sensor.path.empty() && is_same_port(oven.line.port, sensor.path)) {
        table.refuse("port", "the sensor's port", "a port other than sensor.port");
    }
    table.require_all_read();
    return is_enabled ? std::optional(oven) : std::nullopt;
}

StorageConfig read_storage(TomlTable table, int output_rate_hz) {
    StorageConfig storage;
    storage.root = table.path_or_empty("root");
    if (storage.root.empty())
        table.refuse("root", "missing", "the directory for the recorded data");
    // A crystal that differs by more than 1000 ppm is broken, so a larger value is a typing error.
    storage.declared_rate_hz =
        table.number("declared_rate_hz", 0.999 * output_rate_hz, 1.001 * output_rate_hz);
    storage.journal_keep_days =
        static_cast<int>(table.integer_or("journal_keep_days", 30, 0, 36500));
    table.require_all_read();
    return storage;
}

PageConfig read_page(TomlTable table) {
    PageConfig page;
    const std::string listen = table.string_or("listen", to_string(page.listen));
    const auto address = parse_listen(listen);
    if (!address) {
        table.refuse("listen", "not an address and a port",
                     "ADDRESS:PORT, as \"127.0.0.1:8351\" or \"[::1]:8351\"");
    }
    page.listen = *address;
    page.hosts = table.strings("hosts");
    page.token = table.string_or("token", "");
    if (!page.token.empty() && !is_token(page.token)) {
        table.refuse("token", "too weak", "16 or more visible ASCII characters, or \"\"");
    }
    page.assets = table.path_or_empty("assets");
    if (!page.assets.empty() && !std::filesystem::is_directory(page.assets)) {
        table.refuse("assets", "no such directory: " + page.assets.string(),
                     "a directory with the page's files, or \"\"");
    }
    if (!page.listen.is_loopback && page.token.empty()) {
        table.refuse("listen", "other hosts can connect and no token is set",
                     "a loopback address, or set token as well");
    }
    table.require_all_read();
    return page;
}

SurveyConfig read_survey(TomlTable table) {
    SurveyConfig survey;
    if (const auto file = table.path_or_empty("sites"); !file.empty()) {
        if (!std::filesystem::exists(file)) {
            table.refuse("sites", "no such file: " + file.string(), "a CSV file of sites, or \"\"");
        }
        survey.sites = text::read_sites(file);
    }
    if (const auto file = table.path_or_empty("calibration"); !file.empty()) {
        if (!std::filesystem::exists(file)) {
            table.refuse("calibration", "no such file: " + file.string(),
                         "a calibration file written by a351-correct, or \"\"");
        }
        survey.calibration = corrector::read_calibration(file);
    }
    survey.planned = from_seconds(60.0 * table.number_or("occupation_min", 10.0, 1.0, 240.0));
    table.require_all_read();
    return survey;
}

}  // namespace

std::optional<UsbAddress> parse_usb_address(std::string_view text) {
    constexpr std::size_t kDigits = 4;
    const auto hex = [&text](std::size_t at) -> std::optional<int> {
        if (text.size() < at + kDigits) return std::nullopt;
        int value = 0;
        const char* const first = text.data() + at;
        const auto parsed = std::from_chars(first, first + kDigits, value, 16);
        if (parsed.ec != std::errc() || parsed.ptr != first + kDigits || value < 0) {
            return std::nullopt;
        }
        return value;
    };
    constexpr std::size_t kSerialAt = 2 * (kDigits + 1);
    const auto vendor = hex(0);
    const auto product = hex(kDigits + 1);
    if (!vendor || !product || text.size() <= kSerialAt) return std::nullopt;
    if (text[kDigits] != ':' || text[kSerialAt - 1] != ':') return std::nullopt;
    return UsbAddress{*vendor, *product, std::string(text.substr(kSerialAt))};
}

Config read_config(const std::filesystem::path& file) {
    TomlTable root = text::read_toml(file);
    Config config;
    config.file = file;
    config.station = read_station(root.table("station"));
    config.sensor = read_sensor(root.table("sensor"), config.station.codes);
    config.oven = read_oven(root.table("oven"), config.sensor.address);
    config.storage = read_storage(root.table("storage"), config.sensor.settings.output_rate_hz);
    config.page = read_page(root.table("page"));
    config.survey = read_survey(root.table("survey"));
    const auto& unit = config.survey.calibration;
    config.verdict =
        read_verdict(root.table("verdict"), unit ? thresholds_for(*unit) : VerdictOptions{});
    root.require_all_read();
    return config;
}

}  // namespace a351::daemon
