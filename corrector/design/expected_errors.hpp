#pragma once
/// @file
/// Expected standard uncertainties of a planned survey: the covariance of the whole-day model with the
/// plan's set-ups instead of readings.
///
///     const ExpectedErrors errors = expected_errors(plan, sites, usual_unit());
///     errors.u_unknown;            // rms over the unknown stations
///
/// Accuracy on simulated days: corrector/accuracy.md (design_bench.py).

#include <array>
#include <string>
#include <vector>

#include "corrector/design/plan.hpp"
#include "corrector/design/planned_unit.hpp"
#include "corrector/whole_day/day_fit.hpp"

namespace a351::corrector::design {

/// A station of a plan.
struct ExpectedStation {
    std::string site;
    bool is_known = false;  ///< Its gravity is in the table of sites, and held.
    std::size_t set_ups = 0;
    MilliGal u;  ///< Standard uncertainty; of a known station that of its reference, or less.
    /// Sources of u, mGal, in the order of whole_day::ErrorSource; all 0 for an exact reference.
    std::array<double, whole_day::kErrorSources> parts_mgal{};
};

/// A difference of two stations: `u` as in differences.csv of a survey, with the references of both
/// hidden.
struct ExpectedDifference {
    std::string from, to;
    MilliGal u;
};

/// Uncertainties of a plan.
struct ExpectedErrors {
    std::vector<ExpectedStation> stations;        ///< In order of their first visit.
    std::vector<ExpectedDifference> differences;  ///< All pairs, in this order.
    MilliGal u_unknown;  ///< Root of the mean square over the unknown stations.
};

/// Extent of a computation.
enum class Detail { stations, differences };

/// Computes the uncertainties, each the root of the mean square over kCourses courses of the
/// temperature.
///
/// The lags, the size of the axis biases and the noise are taken as known; only their effect on a
/// single day is unknown.  Cost: some 10 ms per course.
/// @param plan   as read_plan() gives it.
/// @param sites  table of the sites.
/// @param detail  stations: without the differences, which take most of the time.
[[nodiscard]] ExpectedErrors expected_errors(const Plan& plan, const std::vector<text::Site>& sites,
                                             const PlannedUnit& unit,
                                             Detail detail = Detail::differences);

}  // namespace a351::corrector::design
