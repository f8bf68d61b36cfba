#pragma once
/// @file
/// The parts of a survey day that a bundle takes home.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bundle/bundle.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"

namespace a351::daemon::bundle {

/// The day, as the daemon knows it.
struct SurveyDay {
    std::filesystem::path root = {};                     ///< Data root.
    std::filesystem::path sites = {}, calibration = {};  ///< Empty: there is none.
    std::string station = {};                    ///< Codes of network and station, as XX_A351.
    std::string configuration = {};              ///< TOML, without the token.
    std::string gravity_so_far = {};             ///< JSON.
    std::vector<events::Occupation> stays = {};  ///< Those that ended, in order of time.
    std::optional<UtcTime> running = {};         ///< Start of the stay that runs.
    UtcTime now;
};

/// Returns the instant from which the recorded files are taken: twelve hours before the first stay
/// of the last survey day, in which the box warms up; without a stay, a day before now.  The
/// corrector looks no further back for the begin of a session (archive::JournalTail).
[[nodiscard]] UtcTime begin_of(const SurveyDay& day);

/// Returns what is to be packed.  `survey.toml` names the files for a351-correct survey.
/// @throws std::system_error  the list of sites or the calibration cannot be read.
[[nodiscard]] Contents contents_of(const SurveyDay& day);

}  // namespace a351::daemon::bundle
