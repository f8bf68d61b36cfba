#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// One set-up of the sensor at a benchmark: what the record between two instants belongs to.
struct OccupationWindow {
    std::string site;
    int number = 1;  ///< Of the stay at this site; several set-ups of one stay share it.
    UtcTime start;
    UtcTime end;
    bool is_flagged = false;                  ///< Not to be used in the fit.
    std::optional<MilliGal> given_tide = {};  ///< Effect on gravity.
    bool is_excluded = false;                 ///< By an amendment.
    std::vector<std::string> notes = {};      ///< What became of it on the way.
};

struct OccupationList {
    std::vector<OccupationWindow> windows;  ///< By start, as they were read.
    std::vector<LeftOut> left_out;
    std::vector<std::string> warnings;  ///< What was passed over or left out, and why.
};

/// Reads `site,occupation,start_utc,end_utc,used,note`, what starts from `from` on and before `to`
/// where they are given; `used` is 1, 0 or empty (= 1).  A column
/// `earth_tide_mgal` may follow.
/// @throws InputError  unknown site, a cell that is not what its column says.
[[nodiscard]] OccupationList read_occupation_table(const std::filesystem::path& file,
                                                   const std::vector<text::Site>& sites,
                                                   const std::optional<UtcTime>& from = {},
                                                   const std::optional<UtcTime>& to = {});

/// The occupations of a survey in an event log (directory `events` of a data root): what starts from
/// `from` on and before `to`; where neither is given, the last survey day (record::kSurveyNight),
/// with a warning that there are others.  One that was never stopped is left out with a warning.
/// @throws InputError  the log has occupations, but none in that time.
[[nodiscard]] OccupationList read_logged_occupations(const std::filesystem::path& events,
                                                     const std::optional<UtcTime>& from = {},
                                                     const std::optional<UtcTime>& to = {});

/// Leaves out, with a warning each, what cannot be: occupations at unknown sites (a slip made in the
/// field), those that end before they start, and those that overlap others.  Of these the one that
/// overlaps most goes first, until none does; where two overlap each other alone both go, since
/// nobody knows which is right.
/// @param origin  file or directory they were read from, for messages.
/// @throws InputError  none is left.
[[nodiscard]] OccupationList leave_out_impossible(OccupationList list,
                                                  const std::vector<text::Site>& sites,
                                                  const std::filesystem::path& origin);

/// Notes that a window has no row, with a warning.
/// @param detail  follows the reason in the warning.
void leave_out(std::vector<LeftOut>& left_out, std::vector<std::string>& warnings,
               const OccupationWindow& window, const std::string& reason,
               const std::string& detail = "");

}  // namespace a351::corrector
