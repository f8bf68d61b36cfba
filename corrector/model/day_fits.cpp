#include "corrector/model/day_fits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "corrector/reading/on_all_cores.hpp"
#include "corrector/whole_day/station_system.hpp"

namespace a351::corrector::model {
namespace {

/// Returns the effective degrees of freedom of a station's uncertainty (Welch and Satterthwaite).
std::optional<double> degrees_of_freedom(const whole_day::GravityEstimate& gravity,
                                         const whole_day::DayFit& fit) {
    if (!fit.noise_log_errors) return std::nullopt;
    double sum = 0.0;
    // Placement, flicker and white are the first sources of errors, too.
    for (std::size_t k = 0; k < fit.noise_log_errors->size(); ++k)
        sum +=
            std::pow(gravity.parts_mgal.at(k), 4) * 2.0 * std::pow(fit.noise_log_errors->at(k), 2);
    return std::pow(gravity.standard_error, 4) / sum;
}

/// Rows and values of one station.
struct Members {
    std::vector<std::size_t> rows;  ///< Accepted rows, or all if none is.
    std::set<std::size_t> numbers;  ///< Numbers of their gravities.
};

Members members_of(const std::vector<CorrectedRow>& rows, const RowChoice& choice,
                   const DayFits& fits, const StationValue& station) {
    Members members;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].row.site != station.site) continue;
        if (!station.is_flagged_only && !choice.accepted[i]) continue;
        members.rows.push_back(i);
        members.numbers.insert(fits.all.stations[i].number);
    }
    return members;
}

/// Returns the errors that a gravity has in common with those of other days.
SharedErrors shared_errors(const std::vector<CorrectedRow>& rows, const Fitted& fitted,
                           const whole_day::GravityEstimate& gravity, bool is_calibrated) {
    SharedErrors shared{gravity.shared_mgal, is_calibrated, {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const whole_day::DayStation& station = fitted.stations[i];
        if (station.gravity && station.u_gravity.value() > 0.0)
            shared.references_mgal[rows[i].row.site] = gravity.of_gravities_mgal[station.number];
    }
    return shared;
}

/// Sets what needs the reference of the station to be hidden; if it alone is held, only the errors
/// of its reference.
void set_left_out(StationValue& station, const std::vector<CorrectedRow>& rows,
                  const Members& members, const DayFits& fits, bool is_calibrated) {
    const Fitted* const other = fits.with_unknown(members.rows.front(), station.site);
    if (other == nullptr) {
        const MilliGal u = rows[members.rows.front()].row.u_reference.value_or(MilliGal(0.0));
        station.shared = SharedErrors{{}, is_calibrated, {{station.site, u.value()}}};
        return;
    }
    double sum = 0.0, squares = 0.0;
    for (const std::size_t i : members.rows) sum += other->fit.set_ups[i].corrected.value();
    for (const std::size_t number : members.numbers)
        squares += std::pow(other->fit.gravity_mgal[number].standard_error, 2);
    station.left_out = MilliGal(sum / static_cast<double>(members.rows.size()));
    station.u_gravity = MilliGal(std::sqrt(squares) / static_cast<double>(members.numbers.size()));
    station.u_left_out = station.u_gravity;
    if (members.numbers.size() != 1) return;
    const whole_day::GravityEstimate& gravity = other->gravity_of(members.rows.front());
    station.errors = StationErrors{gravity.parts_mgal};
    station.shared = shared_errors(rows, *other, gravity, is_calibrated);
    station.dof = degrees_of_freedom(gravity, other->fit);
    station.coverage_factor = kCoverageFactor;
}

void enlarge(std::optional<MilliGal>& u, double factor) {
    if (u) u = MilliGal(factor * u->value());
}

}  // namespace

std::vector<whole_day::DayStation> stations_of(const SurveyProblem& problem,
                                               const RowChoice& choice,
                                               const std::string& left_out) {
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    std::vector<whole_day::DayStation> stations;
    std::map<std::string, std::size_t> numbers;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const reading::SurveyRow& row = rows[i];
        const std::string name =
            choice.accepted[i] ? "station " + row.site : fmt::format("row {}", i);
        whole_day::DayStation station{std::nullopt,
                                      numbers.emplace(name, numbers.size()).first->second,
                                      row.u_reference.value_or(MilliGal(0.0))};
        if (choice.in_use[i] && row.site != left_out) station.gravity = row.reference;
        station.steps = static_cast<std::size_t>(std::ranges::count_if(
            problem.options.steps, [&row](const adjustment::Step& step) { return step.is_before(row); }));
        stations.push_back(station);
    }
    return stations;
}

const Fitted* DayFits::without(const std::string& site) const {
    const auto found = std::ranges::find(left_out, site);
    return found == left_out.end() ? nullptr : others.data() + (found - left_out.begin());
}

const Fitted* DayFits::with_unknown(std::size_t row, const std::string& site) const {
    return all.stations[row].gravity ? without(site) : &all;
}

DayFits fit_with_and_without(const SurveyProblem& problem, const RowChoice& choice,
                             const whole_day::DayPriors& priors) {
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    const reading::DayRecord& day = *problem.day;
    DayFits fits;
    fits.all.stations = stations_of(problem, choice);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string& site = rows[i].site;
        if (choice.in_use[i] && std::ranges::find(fits.left_out, site) == fits.left_out.end())
            fits.left_out.push_back(site);
    }
    if (fits.left_out.size() < 2)
        fits.left_out.clear();  // without the only one, no station would be held
    for (const std::string& site : fits.left_out)
        fits.others.push_back({stations_of(problem, choice, site), {}});
    fits.all.fit = whole_day::fit_day(day, fits.all.stations, nullptr, priors).value();
    reading::on_all_cores(fits.others.size(), [&](std::size_t k) {
        Fitted& other = fits.others[k];
        other.fit = whole_day::fit_day(day, other.stations, &fits.all.fit, priors).value();
    });
    return fits;
}

void enlarge_uncertainties(Fit& result, double factor) {
    for (StationValue& station : result.stations) {
        enlarge(station.u_gravity, factor);
        enlarge(station.u_left_out, factor);
        if (!station.errors) continue;
        for (double& part : station.errors->parts_mgal) part *= factor;
        for (double& part : station.shared->unit_mgal) part *= factor;
        for (auto& [site, part] : station.shared->references_mgal) part *= factor;
    }
    for (StationDifference& difference : result.differences)
        difference.u = MilliGal(factor * difference.u.value());
    if (result.covariance) result.covariance->mgal2 *= factor * factor;
}

void set_day_stations(Fit& result, const SurveyProblem& problem, const RowChoice& choice,
                      const DayFits& fits, const whole_day::DayPriors& priors) {
    const std::vector<CorrectedRow>& rows = result.rows;
    const bool is_calibrated = problem.options.calibration.has_value();
    std::vector<const StationValue*> compared;     // stations with an accepted row
    std::vector<std::size_t> numbers, first_rows;  // of these stations
    for (const std::string& site : station_names(problem.rows)) {
        StationValue station;
        station.site = site;
        station.is_flagged_only = true;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].row.site != site) continue;
            if (!station.reference) station.reference = rows[i].row.reference;
            if (choice.accepted[i]) station.is_flagged_only = false;
        }
        const Members members = members_of(rows, choice, fits, station);
        double sum = 0.0;
        for (const std::size_t i : members.rows) sum += rows[i].corrected.value();
        station.row_count = members.rows.size();
        station.gravity = MilliGal(sum / static_cast<double>(members.rows.size()));
        if (station.reference) station.residual = *station.reference - station.gravity;
        set_left_out(station, rows, members, fits, is_calibrated);
        if (!station.is_flagged_only) {
            numbers.push_back(*members.numbers.begin());
            first_rows.push_back(members.rows.front());
        }
        result.stations.push_back(std::move(station));
    }
    for (const StationValue& station : result.stations)
        if (!station.is_flagged_only) compared.push_back(&station);

    const whole_day::StationSystem system(*problem.day, fits.all.stations, fits.all.fit, priors);
    for (std::size_t b = 0; b < compared.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            const whole_day::Estimate estimate = system.difference(numbers[a], numbers[b]);
            result.differences.push_back(difference_of(*compared[a], *compared[b],
                                                       MilliGal(estimate.value),
                                                       MilliGal(estimate.standard_error)));
        }
    const Eigen::MatrixXd correlation = system.correlation();
    StationCovariance covariance;
    Eigen::VectorXd u(std::ssize(compared));
    for (std::size_t k = 0; k < compared.size(); ++k) {
        covariance.sites.push_back(compared[k]->site);
        const MilliGal held = problem.rows[first_rows[k]].u_reference.value_or(MilliGal(0.0));
        u(static_cast<Eigen::Index>(k)) = compared[k]->u_left_out.value_or(held).value();
    }
    std::vector<Eigen::Index> places(numbers.begin(), numbers.end());
    covariance.mgal2 = u.asDiagonal() * correlation(places, places) * u.asDiagonal();
    result.covariance = std::move(covariance);
}

}  // namespace a351::corrector::model
