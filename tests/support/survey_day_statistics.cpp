#include <Eigen/Dense>
#include <cmath>

#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/slow_signal.hpp"
#include "tests/support/plant_statistics.hpp"

using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace a351::sim {
namespace {

/// Straight line of the difference on temperature, fitted to the rows that the publication used.
struct Line {
    double slope = 0.0, r2 = 0.0, rms = 0.0;
    std::vector<double> left_out_mgal;  ///< Residuals of the other rows.
};

Line fit_line(const std::vector<DayRow>& rows, const Scenario& scenario) {
    double n = 0.0, t = 0.0, d = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (scenario.occupations[i].is_outlier) continue;
        n += 1.0;
        t += rows[i].temperature_degc;
        d += rows[i].difference_mgal;
    }
    t /= n;
    d /= n;
    double tt = 0.0, td = 0.0, dd = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (scenario.occupations[i].is_outlier) continue;
        const double dt = rows[i].temperature_degc - t, dy = rows[i].difference_mgal - d;
        tt += dt * dt;
        td += dt * dy;
        dd += dy * dy;
    }
    Line line;
    line.slope = td / tt;
    double square = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double residual =
            rows[i].difference_mgal - d - line.slope * (rows[i].temperature_degc - t);
        if (scenario.occupations[i].is_outlier) {
            line.left_out_mgal.push_back(residual);
        } else {
            square += residual * residual;
        }
    }
    line.r2 = 1.0 - square / dd;
    line.rms = std::sqrt(square / n);
    return line;
}

/// Returns the coefficient of the temperature rate, in mGal per degC/h, from a fit of the
/// difference to constant + temperature + rate + time.  The rate is the change from the row before,
/// used or not, divided by the time between.
double rate_coefficient(const std::vector<DayRow>& rows, const Scenario& scenario,
                        bool with_outliers) {
    std::vector<Eigen::Vector4d> columns;
    std::vector<double> differences_mgal;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!with_outliers && scenario.occupations[i].is_outlier) continue;
        const double rate = i == 0 ? 0.0
                                   : (rows[i].temperature_degc - rows[i - 1].temperature_degc) /
                                         (rows[i].middle_h - rows[i - 1].middle_h);
        columns.emplace_back(1.0, rows[i].temperature_degc - 42.6, rate, rows[i].middle_h - 8.0);
        differences_mgal.push_back(rows[i].difference_mgal);
    }
    const auto n = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixX4d design(n, 4);
    for (Eigen::Index i = 0; i < n; ++i) design.row(i) = columns[static_cast<std::size_t>(i)];
    const Eigen::Map<const Eigen::VectorXd> y(differences_mgal.data(), n);
    return design.colPivHouseholderQr().solve(y)[2];
}

}  // namespace

std::vector<DayRow> survey_day(const Scenario& scenario, std::uint64_t seed) {
    const auto plan = plan_survey(scenario, seed);
    SlowSignal slow(scenario, plan, seed);
    std::vector<DayRow> rows(plan.size());
    std::vector<int> counts(plan.size());
    for (UtcTime now = scenario.start(); now < scenario.end(); now += std::chrono::seconds(1)) {
        const SlowValue value = slow.next();
        const PlannedSetUp& set_up = plan[value.set_up];
        constexpr std::chrono::seconds kMargin{60};
        if (now < set_up.start + kMargin || now > set_up.end - kMargin) continue;
        DayRow& row = rows[value.set_up];
        row.temperature_degc += value.temperature.value();
        row.difference_mgal +=
            (value.along_vertical + value.along_z - *set_up.site.gravity).value() -
            value.terms_mgal[static_cast<std::size_t>(Term::tide)];
        ++counts[value.set_up];
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].temperature_degc /= counts[i];
        rows[i].difference_mgal /= counts[i];
        rows[i].middle_h = 0.5 *
                           (seconds_between(scenario.start(), plan[i].start) +
                            seconds_between(scenario.start(), plan[i].end)) /
                           3600.0;
    }
    return rows;
}

std::vector<Figure> survey_day_figures(int seeds) {
    const Scenario scenario = load_scenario("tsukuba");
    constexpr double kAny = 1e9;
    std::vector<Figure> figures = {
        {"slope, 16 rows [mGal/degC]", "-29.274", -34.0, -25.0, {}},
        {"R2, 16 rows", "0.9264", 0.83, 0.96, {}},
        {"RMS, 16 rows [mGal]", "2.00", 1.5, 3.0, {}},
        {"residual of No.2 (1) [mGal]", "+13.7", 3.0, kAny, {}},
        {"residual of No.5 (2) [mGal]", "-6.2", -kAny, -3.0, {}},
        {"residual of No.2 (2) [mGal]", "-6.5", -kAny, -3.0, {}},
        {"rate coefficient, 16 rows [mGal/(degC/h)]", "13 +- 6", 8.0, 30.0, {}},
        {"rate coefficient, 19 rows [mGal/(degC/h)]", "27 +- 4", 8.0, 30.0, {}},
    };
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto rows = survey_day(scenario, static_cast<std::uint64_t>(seed));
        const Line line = fit_line(rows, scenario);
        const std::vector<double> values = {line.slope,
                                            line.r2,
                                            line.rms,
                                            line.left_out_mgal[0],
                                            line.left_out_mgal[1],
                                            line.left_out_mgal[2],
                                            rate_coefficient(rows, scenario, false),
                                            rate_coefficient(rows, scenario, true)};
        for (std::size_t i = 0; i < figures.size(); ++i) figures[i].values.push_back(values[i]);
    }
    return figures;
}

}  // namespace a351::sim
