#include "daemon/config/config.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "daemon/config/verdict_config.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/whole_number.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/text/toml_without.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::config {
namespace {

using text::TomlTable;

bool is_code(std::string_view text, std::size_t shortest, std::size_t longest) {
    return text.size() >= shortest && text.size() <= longest &&
           std::ranges::all_of(
               text, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

std::string code_or_refuse(TomlTable& table, std::string_view key, const char* fallback,
                           std::size_t shortest, std::size_t longest, std::string_view allowed) {
    std::string code = table.string_or(key, fallback);
    if (!is_code(code, shortest, longest)) table.refuse(key, "not a SEED code", allowed);
    return code;
}

std::array<std::string, 3> read_axes(TomlTable& table, const std::string& joined) {
    std::array<std::string, 3> axes;
    const bool has_form = joined.size() == 5 && joined[1] == ',' && joined[3] == ',';
    if (has_form) axes = {joined.substr(0, 1), joined.substr(2, 1), joined.substr(4, 1)};
    const std::set<std::string> distinct(axes.begin(), axes.end());
    const auto is_suffix = [](const std::string& axis) { return is_code(axis, 1, 1); };
    if (!std::ranges::all_of(axes, is_suffix) || distinct.size() != axes.size()) {
        table.refuse("axes", "not three channel suffixes",
                     "three different characters A-Z 0-9 for x, y, z, as \"1,2,Z\"");
    }
    return axes;
}

station::Description read_station(TomlTable table) {
    station::Description station;
    station.codes.network =
        code_or_refuse(table, "network", "XX", 1, 2, "1 to 2 characters A-Z 0-9");
    station.codes.station =
        code_or_refuse(table, "station", "A351", 1, 5, "1 to 5 characters A-Z 0-9");
    station.codes.location = table.string_or("location", "00");
    if (!station.codes.location.empty() && !is_code(station.codes.location, 2, 2))
        table.refuse("location", "not a SEED code", "2 characters A-Z 0-9, or empty");
    station.latitude =
        Degrees(table.required_number("latitude", -90, 90, "degrees north, -90 to 90"));
    station.longitude =
        Degrees(table.required_number("longitude", -180, 360, "degrees east, -180 to 360"));
    station.elevation =
        Metres(table.required_number("elevation_m", text::kLeastAltitude_m,
                                     text::kGreatestAltitude_m, "metres above sea, -5000 to 9000"));
    table.require_all_read();
    return station;
}

/// Joins the allowed values for a refusal.
std::string joined(const auto& values) {
    std::string list;
    for (const auto& value : values) list += fmt::format("{}{}", list.empty() ? "" : ", ", value);
    return list;
}

int coded_value(TomlTable& table, std::string_view key, int fallback,
                std::span<const wire::Coded> choices) {
    const auto value = static_cast<int>(table.integer_or(key, fallback, 0, 10'000'000));
    std::vector<int> known;
    for (const wire::Coded& choice : choices) known.push_back(choice.value);
    if (std::ranges::count(known, value) == 0)
        table.refuse(key, "not a known value", joined(known));
    return value;
}

/// Reads `VID:PID:SERIAL` (two hexadecimal numbers of four digits; the serial may contain colons).
/// @return std::nullopt if the text has another form.
std::optional<source::UsbAddress> parse_usb_address(std::string_view text) {
    constexpr std::size_t kDigits = 4, kSerialAt = 2 * (kDigits + 1);
    if (text.size() <= kSerialAt || text[kDigits] != ':' || text[kSerialAt - 1] != ':')
        return std::nullopt;
    const auto read = [](const char* digits, int& value) {
        return std::from_chars(digits, digits + kDigits, value, 16).ptr == digits + kDigits &&
               value >= 0;
    };
    source::UsbAddress address{.serial = std::string(text.substr(kSerialAt))};
    if (!read(text.data(), address.vendor) || !read(text.data() + kDigits + 1, address.product))
        return std::nullopt;
    return address;
}

source::PortAddress read_address(TomlTable& table) {
    source::PortAddress address;
    address.path = table.path_or_empty("port");
    const std::string usb = table.string_or("usb", "");
    if (!usb.empty()) address.usb = parse_usb_address(usb);
    if (!usb.empty() && !address.usb) {
        table.refuse("usb", "not an adapter's address",
                     "VID:PID:SERIAL as printed by a351d --list-ports");
    }
    if (address.path.empty() == !address.usb) {
        table.refuse("port",
                     address.usb ? "given together with usb" : "port and usb are both missing",
                     "exactly one of port and usb");
    }
    return address;
}

/// Reads the name of a shipped profile, or the path of a file.
const wire::DeviceProfile* read_profile(TomlTable& table) {
    const auto* const profile =
        wire::named_or_loaded(table.string_or("profile", "A351"), table.path_or_empty("profile"));
    if (profile == nullptr) {
        table.refuse("profile", "neither a profile nor a file",
                     joined(wire::profile_names()) + ", or a file");
    }
    return profile;
}

void read_filter(TomlTable& table, source::LinkOptions& sensor, station::Description& station) {
    const int rate_hz = sensor.settings.output_rate_hz;
    station.filter = table.string_or("filter", "k512_fc9");
    const wire::FilterSpec* const filter = sensor.profile->filter_named(station.filter);
    const auto rates = filter == nullptr ? std::span<const int>() : filter->allowed_rates_hz;
    if (std::ranges::count(rates, rate_hz) == 0) {
        table.refuse(
            "filter",
            fmt::format("not usable at {} Hz with profile {}", rate_hz, sensor.profile->name),
            joined(sensor.profile->filters_allowed_at(rate_hz)));
    }
    sensor.settings.filter_code = filter->code;
    station.group_delay = sensor.profile->group_delay(*filter);
}

source::LinkOptions read_sensor(TomlTable table, station::Description& station) {
    source::LinkOptions sensor;
    sensor.address = read_address(table);
    sensor.profile = read_profile(table);
    sensor.baud = coded_value(table, "baud", 460800, sensor.profile->baud_rates);
    sensor.settings.output_rate_hz =
        coded_value(table, "output_rate_hz", 50, sensor.profile->output_rates_hz);
    read_filter(table, sensor, station);

    constexpr int kBitsPerByte = 10;  // 8N1: start bit, eight data bits, stop bit.
    const int needed = sensor.settings.output_rate_hz *
                       static_cast<int>(sensor.settings.layout.frame_size()) * kBitsPerByte;
    if (needed > sensor.baud) {
        table.refuse("baud", "too slow for the output rate",
                     fmt::format("at least {} bit/s", needed));
    }
    sensor.expected_serial_number = table.string_or("serial_number", "");
    station.codes.axes = read_axes(table, table.string_or("axes", "1,2,Z"));
    station.profile = sensor.profile->name;
    station.is_profile_verified = sensor.profile->is_verified;
    station.output_rate_hz = sensor.settings.output_rate_hz;
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

/// Reads [oven] or [oven.outer].  The table is also checked if it is not enabled.
/// @param inner  for the outer oven, the inner one.
std::optional<source::OvenLinkOptions> read_oven(
    TomlTable& table, journal::OvenPlace place, const source::PortAddress& sensor,
    const std::optional<source::OvenLinkOptions>& inner) {
    // Rates that libmodbus can set and a line of 500 m can carry; controllers support some of them.
    constexpr std::array kBauds{1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
    const bool is_enabled = table.boolean_or("enabled", false);
    source::OvenLinkOptions oven;
    oven.place = place;
    oven.line.port = table.path_or_empty("port");
    oven.line.baud = static_cast<int>(table.integer_or("baud", 9600, 1200, 115200));
    if (std::ranges::count(kBauds, oven.line.baud) == 0)
        table.refuse("baud", "not a known value", joined(kBauds));
    oven.line.parity = table.choice_or("parity", "E", {"E", "O", "N"}).front();
    // 1 ... 99 by H175-E1, section 1; 0 would address all units.
    oven.line.unit = static_cast<int>(table.integer_or("unit", 1, 1, 99));
    oven.line.is_rs485 = table.boolean_or("rs485", false);
    oven.poll_interval = from_seconds(table.number_or("poll_s", 1.0, 0.1, 3600.0));
    oven.decimals = static_cast<int>(table.integer_or("decimals", 1, 0, oven::kMostDecimals));
    if (is_enabled && oven.line.port.empty())
        table.refuse("port", "missing", "the controller's serial port");
    if (is_enabled && !sensor.path.empty() && is_same_port(oven.line.port, sensor.path))
        table.refuse("port", "the sensor's port", "a port other than sensor.port");
    if (is_enabled && inner && is_same_port(oven.line.port, inner->line.port))
        table.refuse("port", "the inner oven's port", "a port other than oven.port");
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
    storage.record_age = std::chrono::seconds(
        table.integer_or("record_age_s", journal::kLongestRecordAge.count(),
                         journal::kShortestRecordAge.count(), journal::kLongestRecordAge.count()));
    table.require_all_read();
    return storage;
}

/// Returns true for SCHEME://HOST[:PORT] with a name or an IPv4 address: a Content-Security-Policy,
/// which lists the boxes, takes no IPv6 address.  Other characters would end a list in a header.
bool is_origin(std::string_view text) {
    const auto mark = text.find("://");
    if (mark == std::string_view::npos) return false;
    const auto scheme = text.substr(0, mark), rest = text.substr(mark + 3);
    const auto colon = rest.find(':');
    const auto host = rest.substr(0, colon);
    if (colon != std::string_view::npos) {
        const auto port = rest.substr(colon + 1);
        // A browser writes a port without a leading zero.
        if (!parse_whole<std::uint16_t>(port) || port.front() == '0') return false;
    }
    const auto is_of_host = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '.' || c == '-';
    };
    const auto is_edge = [](char c) { return c == '.' || c == '-'; };
    return (scheme == "http" || scheme == "https") && !host.empty() && !is_edge(host.front()) &&
           !is_edge(host.back()) && std::ranges::all_of(host, is_of_host);
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
    for (const std::string& host : page.hosts) {
        constexpr std::string_view kHttps = "https://";
        const std::string name = host.starts_with(kHttps) ? host.substr(kHttps.size()) : host;
        if (name.empty() || name.find_first_of("/ \t") != std::string::npos)
            table.refuse(
                "hosts", "not a host name or an origin",
                "names without a path, as \"laptop.local\" or \"https://gravity.example.org\"");
    }
    page.boxes = table.strings("boxes");
    for (const std::string& box : page.boxes)
        if (!is_origin(box))
            table.refuse(
                "boxes", "not the address of a daemon: " + box,
                "http://HOST:PORT, HOST a name or an IPv4 address, PORT 1 to 65535, without "
                "a path, as \"http://192.0.2.7:8351\"");
    page.token = table.string_or("token", "");
    if (!page.token.empty() && !is_token(page.token))
        table.refuse("token", "too weak", "16 or more visible ASCII characters, or \"\"");
    const std::string& ip = page.listen.ip;
    if (page.token.empty() && !page.listen.is_loopback && ip != "0.0.0.0" && ip != "::")
        table.refuse("listen", "a random token can be read through 127.0.0.1 only",
                     "0.0.0.0 and a port, or a token in page.token");
    page.assets = table.path_or_empty("assets");
    if (!page.assets.empty() && !std::filesystem::is_directory(page.assets)) {
        table.refuse("assets", "no such directory: " + page.assets.string(),
                     "a directory with the page's files, or \"\"");
    }
    table.require_all_read();
    return page;
}

SurveyConfig read_survey(TomlTable table) {
    SurveyConfig survey;
    const auto file_at = [&table](std::string_view key, std::string_view allowed) {
        auto file = table.path_or_empty(key);
        if (!file.empty() && !std::filesystem::exists(file))
            table.refuse(key, "no such file: " + file.string(), allowed);
        return file;
    };
    survey.sites_file = file_at("sites", "a CSV file of sites, or \"\"");
    if (!survey.sites_file.empty()) survey.sites = text::read_sites(survey.sites_file);
    survey.calibration_file =
        file_at("calibration", "a calibration file written by a351-correct, or \"\"");
    if (!survey.calibration_file.empty())
        survey.calibration = unit::read_calibration(survey.calibration_file);
    const double occupation_min = table.number_or("occupation_min", 10.0, 1.0, 240.0);
    survey.planned = from_seconds(60.0 * occupation_min);
    // Two whole minutes between the disturbances give the set-up a scatter.
    constexpr double kShortestSetUp_min = 3.0;
    const auto most_set_ups =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(occupation_min / kShortestSetUp_min));
    survey.set_ups = static_cast<int>(table.integer_or("set_ups", 1, 1, most_set_ups));
    survey.faces = table.string_or("faces", survey.faces);
    if (survey.faces.find_first_not_of("+-") != std::string::npos || !survey.faces.starts_with('+'))
        table.refuse("faces", "not a plan of faces", "signs + and -, beginning with +, as +--+");
    if (survey.faces.size() > 1 && std::ssize(survey.faces) != survey.set_ups)
        table.refuse("faces", "not one face for each of the set_ups",
                     fmt::format("{} signs, or \"+\"", survey.set_ups));
    survey.gravity_every = std::chrono::duration_cast<std::chrono::milliseconds>(
        from_seconds(60.0 * table.number_or("gravity_every_min", 3.0, 0.0, 240.0)));
    table.require_all_read();
    return survey;
}

}  // namespace

bool shows_token(const Config& config) {
    if (config.page.token.empty()) return false;
    std::error_code unknown;
    const auto permissions = std::filesystem::status(config.file, unknown).permissions();
    return !unknown &&
           (permissions & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

Config read_config(const std::filesystem::path& file) {
    TomlTable root = text::read_toml(file);
    Config config;
    config.file = file;
    config.shown = text::toml_without(file, "page", "token");
    config.station = read_station(root.table("station"));
    config.sensor = read_sensor(root.table("sensor"), config.station);
    TomlTable oven = root.table("oven");
    config.oven = read_oven(oven, journal::OvenPlace::inner, config.sensor.address, std::nullopt);
    TomlTable outer = oven.table("outer");
    config.outer_oven =
        read_oven(outer, journal::OvenPlace::outer, config.sensor.address, config.oven);
    outer.require_all_read();
    oven.require_all_read();
    config.station.has_oven = config.oven.has_value();
    config.station.has_outer_oven = config.outer_oven.has_value();
    config.storage = read_storage(root.table("storage"), config.sensor.settings.output_rate_hz);
    config.page = read_page(root.table("page"));
    config.survey = read_survey(root.table("survey"));
    const auto& unit = config.survey.calibration;
    config.verdict =
        read_verdict(root.table("verdict"), unit ? thresholds_for(*unit) : verdict::Options{});
    root.require_all_read();
    return config;
}

journal::Header journal_header(const Config& config, const source::HostClock& clock) {
    journal::Header header;
    header.boot_id = clock.boot_id();
    header.program_version = A351_VERSION;
    header.codes = config.station.codes;
    header.profile = config.station.profile;
    header.output_rate_hz = config.station.output_rate_hz;
    header.filter = config.station.filter;
    header.burst_ctrl = config.sensor.settings.layout.burst_ctrl();
    header.baud = config.sensor.baud;
    header.declared_rate_hz = config.storage.declared_rate_hz;
    header.record_age = config.storage.record_age;
    if (config.oven) header.oven_interval = source::archived_interval(*config.oven, clock);
    if (config.outer_oven)
        header.outer_oven_interval = source::archived_interval(*config.outer_oven, clock);
    return header;
}

}  // namespace a351::daemon::config
