#pragma once
/// @file
/// The plan of a survey day: visits in order of time, as the table of design-format.md.
///
///     const std::vector<text::Site> sites = text::read_sites("sites.csv");
///     const Plan plan = read_plan("plan.csv", sites);
///
/// A visit is a stay at a site.  It has one or several set-ups, which follow each other without a
/// pause: the time to lift and level the box is part of a set-up.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::design {

/// Limits of a plan.  Fewer minutes leave no complete mean of 50 s between the disturbances; the other
/// limits only find slips.
inline constexpr int kMostSetUps = 30;
inline constexpr double kFewestMinutes = 2.0, kMostMinutes = 360.0;

/// Longest pause between two visits, h.  A longer one begins another survey day.
inline constexpr double kLongestPause_h = 6.0;

/// One visit.
struct Visit {
    std::string site;           ///< Name in the table of sites.
    UtcTime start;              ///< The box is on the ground.
    int set_ups = 1;            ///< 1 to kMostSetUps.
    double minutes_each = 0.0;  ///< Duration of a set-up, kFewestMinutes to kMostMinutes.
    /// Faces of the set-ups, signs + and - that begin with +; the last one holds for further set-ups.
    std::string faces = "+";

    /// Returns the duration of the visit, min.
    [[nodiscard]] double minutes() const { return set_ups * minutes_each; }
    /// Returns the instant at which the box is taken away.
    [[nodiscard]] UtcTime end() const { return start + from_seconds(60.0 * minutes()); }
    /// Returns the face of a set-up, 1 or -1.
    /// @param set_up  from 0.
    [[nodiscard]] double face(int set_up) const {
        return faces[std::min(static_cast<std::size_t>(set_up), faces.size() - 1)] == '-' ? -1.0
                                                                                          : 1.0;
    }

    bool operator==(const Visit&) const = default;
};

/// Visits in order of time.  Invariant of the result of read_plan(): no two overlap, no pause is
/// longer than kLongestPause_h, and a site with gravity and one without are visited.
using Plan = std::vector<Visit>;

/// Returns true if the gravity of the visit's site, which is in the table, is known.
[[nodiscard]] bool is_known(const std::vector<text::Site>& sites, const Visit& visit);

/// Returns the times between the visits, s.
[[nodiscard]] std::vector<double> drives_s(const Plan& plan);

/// Reads a plan.
/// @param sites  table of the sites; gravity decides which stations are known.
/// @throws InputError  a cell is not as design-format.md says, a visit begins before the end of the
///                     one before or after a longer pause, no known or no unknown station is visited.
[[nodiscard]] Plan read_plan(const std::filesystem::path& file,
                             const std::vector<text::Site>& sites);

/// Returns the plan as the table that read_plan() reads, with the column faces if the box is turned.
[[nodiscard]] std::string plan_csv(const Plan& plan);

/// Returns true if a visit has two faces.
[[nodiscard]] bool is_turned(const Plan& plan);

/// Returns the time from the first start to the last end, h.
/// @param plan  at least one visit.
[[nodiscard]] double duration_h(const Plan& plan);

}  // namespace a351::corrector::design
