#pragma once
/// @file
/// The daemon's configuration: one strict TOML file (config/a351d.toml is the annotated example).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/listen_address.hpp"
#include "daemon/source/oven_link.hpp"
#include "daemon/source/port.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/unit/calibration.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/handshake.hpp"

namespace a351::daemon {

struct StationConfig {
    record::StationCodes codes;
    Degrees latitude, longitude;  ///< Position of the base station.
    Metres elevation;
};

struct SensorConfig {
    PortAddress address;
    const wire::DeviceProfile* profile = nullptr;  ///< Never null after read_config().
    int baud = 460800;
    wire::SensorSettings settings;
    std::string filter;         ///< Name of settings.filter_code.
    std::string serial_number;  ///< Only serial number accepted; empty accepts any.
};

struct StorageConfig {
    std::filesystem::path root;
    std::optional<double> declared_rate_hz;  ///< Absent until it was measured and set.
    int journal_keep_days = 30;              ///< 0: always.
};

struct PageConfig {
    ListenAddress listen;
    std::vector<std::string> hosts;
    std::string token;             ///< Not empty if other hosts can connect.
    std::filesystem::path assets;  ///< Directory of the page's files; empty: the compiled ones.
};

struct SurveyConfig {
    std::vector<text::Site> sites;  ///< Empty if no file is given.
    std::optional<corrector::Calibration> calibration;
    Nanoseconds planned = std::chrono::minutes(10);  ///< Planned length of an occupation.
};

struct Config {
    std::filesystem::path file;  ///< Path of the file.
    StationConfig station;
    SensorConfig sensor;
    std::optional<OvenLinkOptions> oven;  ///< Absent if not enabled.
    StorageConfig storage;
    PageConfig page;
    SurveyConfig survey;
    VerdictOptions verdict;
};

/// Reads the file; paths in it are relative to its directory.
/// @throws InputError  with file, line, key, value and the allowed values.
[[nodiscard]] Config read_config(const std::filesystem::path& file);

/// Reads `VID:PID:SERIAL` (two hexadecimal numbers of four digits; the serial may contain colons).
/// @return std::nullopt if the text has another form.
[[nodiscard]] std::optional<UsbAddress> parse_usb_address(std::string_view text);

}  // namespace a351::daemon
