#pragma once
/// @file
/// Information for the operator at a benchmark besides the verdict: the running value, the level of
/// the box, and what to do next.  All are functions of occupations and live record only.

#include <optional>
#include <string>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/survey/move_prompt.hpp"
#include "daemon/survey/occupations.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::survey {

/// The mean of an occupation's set-ups, as far as they are in memory.
struct OccupationReading {
    std::optional<MilliGal> value;           ///< Mean of the norm, uncorrected.
    std::optional<MilliGal> standard_error;  ///< Absent if that of any set-up is absent.
};

struct FieldStatus {
    std::optional<verdict::RunningReading> reading;  ///< Reading of the running set-up.
    OccupationReading whole;                         ///< Mean of all set-ups.
    std::optional<double> half_time_s;               ///< Seconds until half time; 0 after it.
    bool proposes_set_up = false;  ///< Half time is past and there was only one set-up.
    std::vector<std::string> warnings;
    std::optional<MovePrompt> moved;  ///< Question about a move of the box; also in the warnings.

    std::optional<live::Level> level;  ///< Tilt relative to the day's first set-up.
    std::string level_site;            ///< Site of that set-up; empty if there is none.
    UtcTime level_utc;                 ///< Start of that set-up.
};

/// Returns the finished occupations of the current survey day (events::kSurveyNight),
/// in time order.
[[nodiscard]] std::vector<events::Occupation> survey_day(const Occupations& occupations,
                                                         UtcTime now);

/// Returns the information for the operator at this time.
[[nodiscard]] FieldStatus field_status(const Occupations& occupations, const live::Record& live,
                                       UtcTime now);

/// Returns the mean of these set-ups.
[[nodiscard]] OccupationReading reading_of(const std::vector<events::Occupation::SetUp>& set_ups,
                                           const live::Record& live, MilliGal target);

struct SiteDistance {
    text::Site site;
    std::optional<Metres> distance;  ///< Absent if the site's position is not known.
};

/// Sorts the sites by their distance from this position, on a sphere of 6371 km radius.  Sites
/// without a position come last, in the order of the list.
[[nodiscard]] std::vector<SiteDistance> nearest_first(const std::vector<text::Site>& sites,
                                                      Degrees latitude, Degrees longitude);

}  // namespace a351::daemon::survey
