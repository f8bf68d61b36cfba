#pragma once
/// @file
/// The daemon's configuration: one strict TOML file (config/a351d.toml is the annotated example).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/listen_address.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/source/oven_link.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::daemon::config {

struct StorageConfig {
    std::filesystem::path root;
    std::optional<double> declared_rate_hz;  ///< Absent until it was measured and set.
    int journal_keep_days = 30;              ///< 0: always.
    /// Age of its first sample at which a record of the archive is written, full or not.
    std::chrono::seconds record_age = journal::kLongestRecordAge;
};

struct PageConfig {
    ListenAddress listen;
    std::vector<std::string> hosts;
    std::vector<std::string> boxes;  ///< Origins of the pages of all daemons of the group.
    std::string token;               ///< Not empty if other hosts can connect.
    std::filesystem::path assets;    ///< Directory of the page's files; empty: the compiled ones.
};

struct SurveyConfig {
    std::filesystem::path sites_file, calibration_file;  ///< Empty if not given.
    std::vector<text::Site> sites;
    std::optional<unit::Calibration> calibration;
    Nanoseconds planned = std::chrono::minutes(10);  ///< Planned length of an occupation.
    int set_ups = 1;                                 ///< Planned set-ups in it.
    std::string faces = "+";                         ///< OccupationOptions::faces.
    /// Real time between two computations of the gravity so far; 0: it is not computed.
    std::chrono::milliseconds gravity_every{std::chrono::minutes(3)};
};

struct Config {
    std::filesystem::path file;    ///< Path of the file.
    std::string shown;             ///< The file without comments and without [page] token.
    station::Description station;  ///< Device and times are added for each session.
    source::LinkOptions sensor;    ///< Header and known stream are added at the start.
    std::optional<source::OvenLinkOptions> oven;        ///< Absent if not enabled.
    std::optional<source::OvenLinkOptions> outer_oven;  ///< [oven.outer]; absent if not enabled.
    StorageConfig storage;
    PageConfig page;
    SurveyConfig survey;
    verdict::Options verdict;
};

/// Reads the file; paths in it are relative to its directory.
/// @throws InputError  with file, line, key, value and the allowed values.
[[nodiscard]] Config read_config(const std::filesystem::path& file);

/// Returns true if the file has a token and every user of this computer may read it.
[[nodiscard]] bool shows_token(const Config& config);

/// Makes the header of the journal; session and device are filled in by the sensor's link.
[[nodiscard]] journal::Header journal_header(const Config& config, const source::HostClock& clock);

}  // namespace a351::daemon::config
