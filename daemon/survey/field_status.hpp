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

/// Where the running stay is in its plan.
struct SetUpPlan {
    int running = 1;      ///< Number of the set-up that runs, counted from 1.
    int planned = 1;      ///< Planned set-ups of a stay.
    double left_s = 0.0;  ///< Seconds left in the set-up, in one beyond the plan in the stay.
    bool proposes_next = false;  ///< The box is to be lifted and set down again now.
    bool may_stop = false;       ///< No planned set-up and no planned time is left.
};

/// Returns the place in the plan: `planned` set-ups of equal length fill `length_s`.  A plan of one
/// set-up proposes a second one at half time, because two half as long give less error.
/// @param running    number of the set-up that runs.
/// @param stay_s     seconds since the start of the stay.
/// @param set_up_s   seconds since the start of this set-up.
[[nodiscard]] SetUpPlan set_up_plan(int planned, double length_s, int running, double stay_s,
                                    double set_up_s);

struct FieldStatus {
    std::optional<verdict::RunningReading> reading;  ///< Reading of the running set-up.
    verdict::RunningReading whole;  ///< All set-ups; good enough only if the planned ones began.
    SetUpPlan plan;
    std::vector<text::Message> warnings;
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

struct SiteDistance {
    text::Site site;
    std::optional<Metres> distance;  ///< Absent if the site's position is not known.
};

/// Sorts the sites by their distance from this position, on a sphere of 6371 km radius.  Sites
/// without a position come last, in the order of the list.
[[nodiscard]] std::vector<SiteDistance> nearest_first(const std::vector<text::Site>& sites,
                                                      Degrees latitude, Degrees longitude);

}  // namespace a351::daemon::survey
