#pragma once
/// @file
/// The occupations of a survey, from a table or from the event log.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// One set-up of the sensor at a benchmark, from its start to its end.
struct OccupationWindow {
    std::string site;
    int number = 1;  ///< Number of the stay at this site; all set-ups of one stay share it.
    UtcTime start;
    UtcTime end;
    bool is_flagged = false;                  ///< Marked as not to be used in the fit.
    std::optional<MilliGal> given_tide = {};  ///< Effect of the tide on gravity.
    bool is_excluded = false;                 ///< Excluded from every fit by an amendment.
    std::vector<std::string> notes = {};      ///< Flags for the table, e.g. "no-stop".
};

struct OccupationList {
    std::vector<OccupationWindow> windows;  ///< Set-ups in order of start.
    std::vector<LeftOut> left_out;
    std::vector<std::string> warnings;  ///< Entries skipped or left out, with the reason.
};

/// Reads a table `site,occupation,start_utc,end_utc,used,note`.  `used` is 1, 0 or empty (= 1).  A
/// column `earth_tide_mgal` is optional.
/// @param from, to  if given, only occupations that start at or after `from` and before `to`.
/// @throws InputError  unknown site, a cell that does not fit its column, no occupation in that
///                     time.
[[nodiscard]] OccupationList read_occupation_table(const std::filesystem::path& file,
                                                   const std::vector<text::Site>& sites,
                                                   const std::optional<UtcTime>& from = {},
                                                   const std::optional<UtcTime>& to = {});

/// Reads the occupations of a survey from an event log (directory `events` of a data root).
///
/// An occupation that was not stopped lasts until the next start, with the note no-stop and a
/// warning.  The last occupation of the log is left out with a warning if it was not stopped.
/// @param from, to  only occupations that start at or after `from` and before `to`.  If neither is
///                  given: the last survey day (record::kSurveyNight), with a warning if there are
///                  others.
/// @throws InputError  the log has occupations, but none in that time.
[[nodiscard]] OccupationList read_logged_occupations(const std::filesystem::path& events,
                                                     const std::optional<UtcTime>& from = {},
                                                     const std::optional<UtcTime>& to = {});

/// Leaves out impossible occupations, with a warning for each.
///
/// These are occupations at unknown sites (a slip made in the field), those that end before they
/// start, and those that overlap others.  The one that overlaps most others is left out first, and
/// so on until none overlaps.  If two overlap only each other, both are left out, because it is not
/// known which one is right.
/// @param origin  file or directory from which they were read, for messages.
/// @throws InputError  none is left.
[[nodiscard]] OccupationList drop_invalid_occupations(OccupationList list,
                                                      const std::vector<text::Site>& sites,
                                                      const std::filesystem::path& origin);

/// Adds an occupation without a row to `left_out`, and a warning.
/// @param detail  text after the reason in the warning.
void leave_out(std::vector<LeftOut>& left_out, std::vector<std::string>& warnings,
               const OccupationWindow& window, const std::string& reason,
               const std::string& detail = "");

}  // namespace a351::corrector
