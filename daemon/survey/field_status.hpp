#pragma once
/// @file
/// What the operator at a benchmark wants to know besides the verdict: the running value, how the
/// box stands, what to do next.  Functions of occupations and live record alone.

#include <optional>
#include <string>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/survey/occupations.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon {

/// Mean of an occupation's set-ups as far as they are remembered.
struct OccupationReading {
    std::optional<MilliGal> value;           ///< Mean of the norm, no correction.
    std::optional<MilliGal> standard_error;  ///< Absent while that of one set-up is.
};

struct FieldStatus {
    /// Of the running set-up, the others below.
    std::optional<RunningReading> reading;
    OccupationReading whole;
    std::optional<double> half_time_s;  ///< Until then; 0 when it is past.
    bool proposes_set_up = false;       ///< Half time is past and there was one set-up.
    std::vector<std::string> warnings;

    std::optional<Level> level;  ///< Against the day's first set-up ...
    std::string level_site;      ///< ... which was here, from `level_utc` on.
    UtcTime level_utc;
};

/// The finished occupations of the survey day that ends now (record::kSurveyNight), in time order.
[[nodiscard]] std::vector<record::Occupation> survey_day(const Occupations& occupations,
                                                         UtcTime now);

[[nodiscard]] FieldStatus field_status(const Occupations& occupations, const LiveRecord& live,
                                       UtcTime now);

[[nodiscard]] OccupationReading reading_of(const std::vector<record::Occupation::SetUp>& set_ups,
                                           const LiveRecord& live, MilliGal target);

struct SiteDistance {
    text::Site site;
    std::optional<Metres> distance;  ///< Absent where a position is not known.
};

/// Nearest first to `from`, those without a position last, in the order of the list.  Distances on
/// a sphere of 6371 km.
[[nodiscard]] std::vector<SiteDistance> nearest_first(const std::vector<text::Site>& sites,
                                                      Degrees latitude, Degrees longitude);

}  // namespace a351::daemon
