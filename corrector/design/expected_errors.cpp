#include "corrector/design/expected_errors.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/archive_series/on_all_cores.hpp"
#include "corrector/design/planned_day.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::design {
namespace {

/// Mean squares of one course, mGal^2.
struct Squares {
    std::vector<double> stations;  ///< Squares of the uncertainties, by number.
    std::vector<std::array<double, whole_day::kErrorSources>> parts;  ///< The same for each source.
    std::vector<double> differences;  ///< In the order of ExpectedErrors; empty if not wanted.
};

Squares squares_of(PlannedDay day, const PlannedUnit& unit, bool has_differences) {
    // The plan visits a known station, so there is a fit.
    const whole_day::DayAdjustment adjusted =
        whole_day::adjust_planned_day(day.record, {nullptr, day.stations, unit.priors}, unit.noise)
            .value();
    Squares squares;
    for (std::size_t number = 0; number < day.sites.size(); ++number) {
        const whole_day::GravityEstimate gravity = adjusted.gravity(number);
        squares.stations.push_back(gravity.standard_error * gravity.standard_error);
        auto& parts = squares.parts.emplace_back();
        for (std::size_t k = 0; k < parts.size(); ++k)
            parts.at(k) = gravity.parts_mgal.at(k) * gravity.parts_mgal.at(k);
    }
    if (!has_differences) return squares;
    for (std::size_t to = 1; to < day.sites.size(); ++to)
        for (std::size_t from = 0; from < to; ++from)
            squares.differences.push_back(
                std::pow(adjusted.difference(from, to).standard_error, 2));
    return squares;
}

/// Returns the squares of all courses.
std::vector<Squares> squares_of_courses(const Plan& plan, const std::vector<text::Site>& sites,
                                        const PlannedUnit& unit, bool has_differences) {
    std::vector<Squares> all(kCourses);
    archive_series::on_all_cores(kCourses, [&](std::size_t course) {
        all[course] = squares_of(planned_day(plan, sites, unit, course), unit, has_differences);
    });
    return all;
}

/// Returns the root of the mean of a value over the courses.
template <class Value>
double root_mean(const std::vector<Squares>& all, Value value) {
    double sum = 0.0;
    for (const Squares& one : all) sum += value(one);
    return std::sqrt(sum / static_cast<double>(all.size()));
}

}  // namespace

ExpectedErrors expected_errors(const Plan& plan, const std::vector<text::Site>& sites,
                               const PlannedUnit& unit, Detail detail) {
    const std::vector<Squares> all =
        squares_of_courses(plan, sites, unit, detail == Detail::differences);
    ExpectedErrors errors;
    for (const Visit& visit : plan) {
        auto station = std::ranges::find(errors.stations, visit.site, &ExpectedStation::site);
        if (station == errors.stations.end()) {
            const std::size_t number = errors.stations.size();
            station = errors.stations.emplace(station);
            station->site = visit.site;
            station->is_known = is_known(sites, visit);
            station->u =
                MilliGal(root_mean(all, [&](const Squares& s) { return s.stations[number]; }));
            for (std::size_t k = 0; k < station->parts_mgal.size(); ++k)
                station->parts_mgal.at(k) =
                    root_mean(all, [&](const Squares& s) { return s.parts[number].at(k); });
        }
        station->set_ups += static_cast<std::size_t>(visit.set_ups);
    }
    double sum = 0.0, count = 0.0;
    for (const ExpectedStation& station : errors.stations) {
        if (station.is_known) continue;
        sum += station.u.value() * station.u.value();
        count += 1.0;
    }
    errors.u_unknown = MilliGal(std::sqrt(sum / count));
    if (detail == Detail::stations) return errors;
    for (std::size_t to = 1; to < errors.stations.size(); ++to)
        for (std::size_t from = 0; from < to; ++from) {
            const std::size_t k = errors.differences.size();
            errors.differences.push_back(
                {errors.stations[from].site, errors.stations[to].site,
                 MilliGal(root_mean(all, [k](const Squares& s) { return s.differences[k]; }))});
        }
    return errors;
}

}  // namespace a351::corrector::design
