#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
};

struct OccupationList {
    std::vector<OccupationWindow> windows;  ///< By start; they do not overlap.
    std::vector<std::string> warnings;      ///< What was passed over, and why.
};

/// Reads `site,occupation,start_utc,end_utc,used,note`; `used` is 1, 0 or empty (= 1).  A column
/// `earth_tide_mgal` may follow.
/// @throws InputError  unknown site, an end not after its start, windows that overlap, no row.
[[nodiscard]] OccupationList read_occupation_table(const std::filesystem::path& file,
                                                   const std::vector<text::Site>& sites);

/// The occupations of an event log (directory `events` of a data root).  One at an unknown site,
/// a slip made in the field, is left out with a warning, and so is one that was never stopped.
/// @throws InputError  windows that overlap, no occupation left.
[[nodiscard]] OccupationList read_logged_occupations(const std::filesystem::path& events,
                                                     const std::vector<text::Site>& sites);

}  // namespace a351::corrector
