#pragma once
/// @file
/// The occupations of a survey, from a table or from the event log.
///
/// An occupation is a stay at a benchmark; it has one or more set-ups of the sensor, and each
/// set-up is a window.  Order of use:
///
///     OccupationList list = read_logged_occupations(root / "events");   // or from a table
///     amend(list.windows, amendments_file, sites);                      // optional
///     list = drop_invalid_occupations(std::move(list), sites, root / "events");
///
/// A table is written with care, so a mistake in it is refused.  A log is written in the field, so
/// a mistake in it costs only its own occupation, with a warning.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/face.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::reading {

/// One set-up of the sensor at a benchmark, from its start to its end.
///
/// Invariant after drop_invalid_occupations(): the site is known, start < end, and no two windows
/// overlap.
struct OccupationWindow : SetUp {
    /// First instant of the set-up.
    UtcTime start;
    /// End of the set-up.  Samples before this instant are used.
    UtcTime end;
    bool is_last = false;  ///< The log ends without its stop.
    /// The operator says that the box was not moved before this instant.
    std::optional<UtcTime> not_moved_until = {};
    /// Face by the operator and by the daemon's plan.  The data decide which one it is.
    events::StatedFace face = {};
};

/// The set-ups of a survey.  Each set-up of the input is in `windows` or in `left_out`, except those
/// outside the time that was asked for.
struct OccupationList {
    std::vector<OccupationWindow> windows;  ///< Set-ups in order of start.
    std::vector<LeftOut> left_out;          ///< Set-ups that cannot be used, in order of discovery.
    std::vector<text::Message> warnings;    ///< Entries skipped or left out, with the reason.
    std::string running_key = {};           ///< Key of the stay that still runs; may be empty.
};

/// Reads a table `site,occupation,start_utc,end_utc,used,note`.  `used` is 1, 0 or empty (= 1).  A
/// column `earth_tide_mgal` is optional, `instrument_height_m` too, and `face`, which is +, - or empty.
///
/// `used` is optional too, and `note` is not read.  Times without a zone are UTC.  The tide is from
/// -1 to 1 mGal or empty, the number of the stay from 1 to 10^6.  An end before its start is not
/// refused here.  A table without rows gives an empty list.
/// @param from, to  if given, only occupations that start at or after `from` and before `to`.
/// @return the windows in order of start; no warnings.
/// @throws InputError  unknown site, a cell that does not fit its column, no occupation in that
///                     time; with file, line, column and value.  Also if the file cannot be read
///                     or lacks a column.
[[nodiscard]] OccupationList read_occupation_table(const std::filesystem::path& file,
                                                   const std::vector<text::Site>& sites,
                                                   const std::optional<UtcTime>& from = {},
                                                   const std::optional<UtcTime>& to = {});

/// Reads the occupations of a survey from an event log (directory `events` of a data root).
///
/// An occupation that was not stopped lasts until the next start, with the note no-stop and a
/// warning.  The last one of the log lasts until the end of the record, at most kSurveyNight.
///
/// Stays are numbered over the whole log, also if only a day of it is used.  Lines that are not
/// events are skipped with a warning.  A directory that does not exist gives an empty list.  Sites
/// are not checked here.
///
/// @param from, to  only occupations that start at or after `from` and before `to`.  If neither is
///                  given: the last survey day (events::kSurveyNight), with a warning if there are
///                  others.
/// @param running_until  if given, an occupation that still runs is included as if it were stopped
///                       at this instant, or at the next later start.
/// @throws InputError  the log has occupations, but none in that time.
[[nodiscard]] OccupationList read_logged_occupations(
    const std::filesystem::path& events, const std::optional<UtcTime>& from = {},
    const std::optional<UtcTime>& to = {}, const std::optional<UtcTime>& running_until = {});

/// Leaves out impossible occupations, with a warning for each.
///
/// These are occupations at unknown sites (a slip made in the field), those that end before they
/// start, and those that overlap others.  The one that overlaps most others is left out first, and
/// so on until none overlaps.  If two overlap only each other, both are left out, because it is not
/// known which one is right.
///
/// A window that begins at the end of another does not overlap it.  The reasons are "not in the
/// table of sites", "ends before it starts" (also without duration) and "overlaps another", checked
/// in this order.
/// @param origin  file or directory from which they were read, for messages.
/// @return the list with its windows in order of start, at least one; `left_out` and `warnings`
///         are extended.
/// @throws Refused  none is left; the message has all warnings.
[[nodiscard]] OccupationList drop_invalid_occupations(OccupationList list,
                                                      const std::vector<text::Site>& sites,
                                                      const std::filesystem::path& origin);

/// Adds an occupation without a row to `left_out`, and a warning.
///
/// The warning is "SITE (NUMBER) at START is left out: REASON" and the detail.
/// @param reason  a few words without the site; the printed table uses them as a flag.
/// @param detail  text after the reason in the warning, with its own comma or blank in front.
void leave_out(std::vector<LeftOut>& left_out, std::vector<text::Message>& warnings,
               const OccupationWindow& window, const std::string& reason,
               const text::Message& detail = {});

}  // namespace a351::corrector::reading
