#pragma once
/// @file
/// Information for the operator at a benchmark besides the signal: the running value, the level of
/// the box, and what looks wrong.  All are functions of occupations and live record only.

#include <optional>
#include <string>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/survey/move_prompt.hpp"
#include "daemon/survey/occupations.hpp"
#include "daemon/survey/signal.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::survey {

/// Returns the running stay as the signal sees it at an instant; std::nullopt before its start, and if
/// none runs.
[[nodiscard]] std::optional<PlannedStay> planned_stay(const Occupations& occupations,
                                                      const live::Record& live, UtcTime at);

struct FieldStatus {
    std::optional<verdict::RunningReading> reading;  ///< Reading of the running set-up.
    verdict::RunningReading whole;                   ///< Reading of all set-ups.
    std::optional<PlannedStay> stay;
    std::vector<text::Message> warnings;
    std::optional<MovePrompt> moved;  ///< Question about a move of the box.
    text::Message face;               ///< See wrong_face().

    /// Tilt relative to the day's first set-up.  Absent while the box must not be touched.
    std::optional<live::Level> level;
    std::string level_site;  ///< Site of that set-up; empty if there is none.
    UtcTime level_utc;       ///< Start of that set-up.
};

/// Returns the finished occupations of the current survey day (events::kSurveyNight),
/// in time order.
[[nodiscard]] std::vector<events::Occupation> survey_day(const Occupations& occupations,
                                                         UtcTime now);

/// Returns the question to the operator about a move of the box in the running set-up.
[[nodiscard]] std::optional<MovePrompt> moved_box(const Occupations& occupations,
                                                  const live::Record& live, UtcTime now);

/// Returns a sentence if the box lies on its side in the running set-up, or is not in the planned face,
/// compared with the first set-up of the stay, and was not entered so, or not in the face that was
/// entered; empty otherwise, or if the face is not known.  Only the first two do not count in the plan.
[[nodiscard]] text::Message wrong_face(const Occupations& occupations, const live::Record& live,
                                       UtcTime now);

/// Returns the face that the plan asks for in a set-up that begins at an instant; std::nullopt without a
/// plan of faces, and if the face of the first set-up is not known.
[[nodiscard]] std::optional<int> next_planned_face(const Occupations& occupations,
                                                   const live::Record& live, UtcTime at);

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
