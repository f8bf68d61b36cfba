#include "corrector/day/day_model.hpp"

#include <nlopt.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "corrector/day/day_columns.hpp"

namespace a351::corrector {
namespace {

using Index = Eigen::Index;

constexpr double kSecondsPerHour = 3600.0;
constexpr double kReferenceTemperature_degc = 42.5;  // set point of the publication's oven
constexpr double kWarmUp_h = 2.5;                    // of the publication's sensor, after power-on
constexpr double kAnything_mgal = 1e4;               // of a constant and of gravity: no prior

struct Prior {
    double mean, deviation;
};
constexpr std::array<Prior, kDayTerms> kPriors{{{0.0, kAnything_mgal},
                                                {-12.0, 12.0},
                                                {-20.0, 20.0},
                                                {11.3, 11.3},
                                                {0.0, 1.0},
                                                {0.0, 36.0},
                                                {0.0, 2000.0},
                                                {0.0, 2000.0}}};

/// Lags and noise are median x factor^u, u normal.
struct LogNormal {
    double median, factor;
    [[nodiscard]] double at(double u) const { return median * std::pow(factor, u); }
};
constexpr LogNormal kFastLag_s{43.0, 1.5}, kSlowLag_s{2700.0, 1.5};
constexpr LogNormal kPlacement_mgal{1.2, 2.0}, kFlicker_mgal{1.2, 2.0};
constexpr double kWhiteFactor = 2.0;

enum Hyper { fast_lag, slow_lag, placement, flicker, white };
constexpr std::size_t kHypers = std::tuple_size_v<DayFit::Point>;
constexpr double kFarthest = 12.0;  // standard deviations of the priors: anything at all

std::size_t unknown_count(const std::vector<DayStation>& stations) {
    std::size_t count = 0;
    for (const DayStation& station : stations)
        if (!station.gravity) count = std::max(count, station.unknown + 1);
    return count;
}

/// Of the difference of neighbouring bins, robustly; a bound for the white noise.
double bin_scatter_mgal(const std::vector<DayBin>& bins) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < bins.size(); ++i)
        if (bins[i].set_up == bins[i - 1].set_up)
            steps.push_back(std::abs((bins[i].reading - bins[i - 1].reading).value()));
    if (steps.empty()) return 1.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    constexpr double kMedianToDeviation = 1.4826;
    return std::max(*middle * kMedianToDeviation / std::sqrt(2.0), 1e-3);
}

class DayProblem {
public:
    DayProblem(const DayRecord& record, const std::vector<DayStation>& stations)
        : record_(record),
          stations_(stations),
          unknowns_(static_cast<Index>(unknown_count(stations))),
          means_(record.temperature.series, record.bins),
          white_mgal_{bin_scatter_mgal(record.bins), kWhiteFactor} {
        set_readings();
        set_fixed_columns();
    }

    using Point = DayFit::Point;

    /// - log (restricted likelihood x priors), up to a constant.
    [[nodiscard]] double cost(const Point& u) const {
        Eigen::MatrixXd columns = whitened_input(u);
        const double log_determinant = whiten(record_.bins, noise_at(u), columns);
        const auto y = columns.col(0);
        const auto x = columns.rightCols(columns.cols() - 1);
        Eigen::MatrixXd normal = x.transpose() * x;
        normal.diagonal().array() += 1.0;
        const Eigen::LLT<Eigen::MatrixXd> factor(normal);
        const Eigen::VectorXd half = factor.matrixL().solve(x.transpose() * y);
        const double log_normal = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
        double sum = log_determinant + log_normal + y.squaredNorm() - half.squaredNorm();
        for (const double value : u) sum += value * value;
        return 0.5 * sum;
    }

    /// From afar by subplexes, which no shape of the cost stops short; from nearby by parabolas, which
    /// need a fifth of the time.
    [[nodiscard]] Point most_likely(const std::optional<Point>& nearby) const {
        const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
            nlopt_create(nearby ? NLOPT_LN_BOBYQA : NLOPT_LN_SBPLX, kHypers), &nlopt_destroy);
        const auto cost_of = [](unsigned, const double* u, double*, void* problem) {
            Point point;
            std::copy_n(u, kHypers, point.begin());
            return static_cast<const DayProblem*>(problem)->cost(point);
        };
        nlopt_set_min_objective(search.get(), cost_of, const_cast<DayProblem*>(this));
        nlopt_set_lower_bounds1(search.get(), -kFarthest);
        nlopt_set_upper_bounds1(search.get(), kFarthest);
        nlopt_set_initial_step1(search.get(), 0.5);
        nlopt_set_xtol_abs1(search.get(), 1e-3);
        nlopt_set_maxeval(search.get(), 2000);
        Point u = nearby.value_or(Point{});
        double least = 0.0;
        nlopt_optimize(search.get(), u.data(), &least);
        return u;
    }

    [[nodiscard]] DayFit fit_at(const Point& u) const;

private:
    void set_readings();
    void set_fixed_columns();
    [[nodiscard]] Index terms() const { return static_cast<Index>(kDayTerms); }

    [[nodiscard]] DayNoise noise_at(const Point& u) const {
        return {kPlacement_mgal.at(u[placement]), kFlicker_mgal.at(u[flicker]),
                white_mgal_.at(u[white])};
    }
    [[nodiscard]] Eigen::VectorXd fast_column(double lag_s) const;
    [[nodiscard]] Eigen::VectorXd slow_column(double lag_s) const;

    /// (n, terms + unknowns) in the units of the terms.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u) const;

    /// (n, 1 + terms + unknowns): readings less what the priors expect, and the design in units of
    /// the priors' deviations.
    [[nodiscard]] Eigen::MatrixXd whitened_input(const Point& u) const;

    const DayRecord& record_;
    const std::vector<DayStation>& stations_;
    Index unknowns_;
    BinMeans means_;
    LogNormal white_mgal_;
    std::vector<double> rough_mgal_;  ///< Of each unknown.
    Eigen::VectorXd readings_mgal_;   ///< (n) less tide and gravity, held or rough.
    Eigen::MatrixXd fixed_;           ///< The design, lagged columns left 0.
};

void DayProblem::set_readings() {
    const auto count = static_cast<Index>(record_.bins.size());
    readings_mgal_.resize(count);
    double held_sum = 0.0, held_count = 0.0;
    std::vector<double> sums(static_cast<std::size_t>(unknowns_)), counts(sums.size());
    for (Index i = 0; i < count; ++i) {
        const DayBin& bin = record_.bins[static_cast<std::size_t>(i)];
        const DayStation& station = stations_[bin.set_up];
        readings_mgal_(i) = (bin.reading - station.tide).value();
        if (station.gravity) {
            readings_mgal_(i) -= station.gravity->value();
            held_sum += readings_mgal_(i);
            held_count += 1.0;
        } else {
            sums[station.unknown] += readings_mgal_(i);
            counts[station.unknown] += 1.0;
        }
    }
    const double constant = held_sum / held_count;
    rough_mgal_.resize(sums.size());
    for (std::size_t k = 0; k < sums.size(); ++k)
        rough_mgal_[k] = counts[k] > 0.0 ? sums[k] / counts[k] - constant : 0.0;
    for (Index i = 0; i < count; ++i) {
        const DayStation& station = stations_[record_.bins[static_cast<std::size_t>(i)].set_up];
        if (!station.gravity) readings_mgal_(i) -= rough_mgal_[station.unknown];
    }
}

void DayProblem::set_fixed_columns() {
    const auto count = static_cast<Index>(record_.bins.size());
    fixed_ = Eigen::MatrixXd::Zero(count, terms() + unknowns_);
    const auto column = [this](DayTerm term) { return fixed_.col(static_cast<Index>(term)); };
    column(DayTerm::constant).setOnes();
    column(DayTerm::level) =
        means_.of(record_.temperature.series.values()).array() - kReferenceTemperature_degc;
    const UtcTime begin = record_.temperature.series.start();
    const UtcTime middle =
        record_.bins.front().time + (record_.bins.back().time - record_.bins.front().time) / 2;
    for (Index i = 0; i < count; ++i) {
        const DayBin& bin = record_.bins[static_cast<std::size_t>(i)];
        column(DayTerm::drift)(i) = seconds_between(middle, bin.time) / kSecondsPerHour;
        column(DayTerm::warm_up)(i) =
            std::exp(-seconds_between(begin, bin.time) / kSecondsPerHour / kWarmUp_h);
        column(DayTerm::x)(i) = bin.x.value();
        column(DayTerm::y)(i) = bin.y.value();
        const DayStation& station = stations_[bin.set_up];
        if (!station.gravity) fixed_(i, terms() + static_cast<Index>(station.unknown)) = 1.0;
    }
}

Eigen::VectorXd DayProblem::fast_column(double lag_s) const {
    const TimeSeries<DegC>& temperature = record_.temperature.series;
    std::vector<double> rate = lagged(temperature, lag_s);
    for (std::size_t i = 0; i < rate.size(); ++i)
        rate[i] = (temperature.values()[i] - rate[i]) / lag_s * kSecondsPerHour;
    return means_.of(rate);
}

Eigen::VectorXd DayProblem::slow_column(double lag_s) const {
    return means_.of(lagged(record_.temperature.series, lag_s)).array() -
           kReferenceTemperature_degc;
}

Eigen::MatrixXd DayProblem::design(const Point& u) const {
    Eigen::MatrixXd columns = fixed_;
    columns.col(static_cast<Index>(DayTerm::fast)) = fast_column(kFastLag_s.at(u[fast_lag]));
    columns.col(static_cast<Index>(DayTerm::slow)) = slow_column(kSlowLag_s.at(u[slow_lag]));
    return columns;
}

Eigen::MatrixXd DayProblem::whitened_input(const Point& u) const {
    const Eigen::MatrixXd x = design(u);
    Eigen::MatrixXd input(x.rows(), x.cols() + 1);
    input.col(0) = readings_mgal_;
    for (Index k = 0; k < x.cols(); ++k) {
        const Prior prior =
            k < terms() ? kPriors.at(static_cast<std::size_t>(k)) : Prior{0.0, kAnything_mgal};
        input.col(0) -= prior.mean * x.col(k);
        input.col(k + 1) = prior.deviation * x.col(k);
    }
    return input;
}

DayFit DayProblem::fit_at(const Point& u) const {
    const auto set_ups = static_cast<Index>(stations_.size());
    const Index estimated = terms() + unknowns_;
    constexpr Index kLags = 2;
    Eigen::MatrixXd x = design(u);

    // Estimates first, for what the lags do depends on them.
    const auto solve = [&](const Eigen::MatrixXd& columns) {
        const auto used = columns.middleCols(1, estimated);
        Eigen::MatrixXd normal = used.transpose() * used;
        normal.diagonal().array() += 1.0;
        return Eigen::VectorXd(normal.llt().solve(used.transpose() * columns.col(0)));
    };
    Eigen::MatrixXd columns = whitened_input(u);
    columns.conservativeResize(Eigen::NoChange, 1 + estimated + kLags + set_ups);
    columns.rightCols(kLags + set_ups).setZero();
    for (std::size_t i = 0; i < record_.bins.size(); ++i)
        columns(static_cast<Index>(i),
                1 + estimated + kLags + static_cast<Index>(record_.bins[i].set_up)) = 1.0;
    Eigen::MatrixXd first = columns.leftCols(1 + estimated);
    whiten(record_.bins, noise_at(u), first);
    const Eigen::VectorXd scaled = solve(first);

    DayFit fit;
    fit.point = u;
    fit.noise = noise_at(u);
    fit.fast_lag_s = kFastLag_s.at(u[fast_lag]);
    fit.slow_lag_s = kSlowLag_s.at(u[slow_lag]);
    fit.log_likelihood = -cost(u);
    Eigen::VectorXd coefficients(estimated);
    for (Index k = 0; k < estimated; ++k) {
        const Prior prior =
            k < terms() ? kPriors.at(static_cast<std::size_t>(k)) : Prior{0.0, kAnything_mgal};
        coefficients(k) = prior.mean + prior.deviation * scaled(k);
    }

    // Lags: what one standard deviation of the prior changes in the fit, as two more terms.
    constexpr double kStep = 0.1;
    const Index lag_column = 1 + estimated;
    columns.col(lag_column) = coefficients(static_cast<Index>(DayTerm::fast)) / (2.0 * kStep) *
                              (fast_column(kFastLag_s.at(u[fast_lag] + kStep)) -
                               fast_column(kFastLag_s.at(u[fast_lag] - kStep)));
    columns.col(lag_column + 1) = coefficients(static_cast<Index>(DayTerm::slow)) / (2.0 * kStep) *
                                  (slow_column(kSlowLag_s.at(u[slow_lag] + kStep)) -
                                   slow_column(kSlowLag_s.at(u[slow_lag] - kStep)));
    whiten(record_.bins, fit.noise, columns);
    const auto used = columns.middleCols(1, estimated + kLags);
    Eigen::MatrixXd normal = used.transpose() * used;
    normal.diagonal().array() += 1.0;
    const Eigen::VectorXd variances =
        normal.llt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())).diagonal();
    for (Index k = 0; k < terms(); ++k) {
        const auto term = static_cast<std::size_t>(k);
        fit.coefficients.at(term) = {coefficients(k),
                                     kPriors.at(term).deviation * std::sqrt(variances(k))};
    }
    for (Index k = 0; k < unknowns_; ++k)
        fit.unknown_mgal.push_back(
            {rough_mgal_[static_cast<std::size_t>(k)] + coefficients(terms() + k),
             kAnything_mgal * std::sqrt(variances(terms() + k))});

    // Expected placement of each set-up, given all readings.
    const Eigen::VectorXd left = columns.col(0) - columns.middleCols(1, estimated) * scaled;
    const Eigen::VectorXd placements = fit.noise.placement_mgal * fit.noise.placement_mgal *
                                       (columns.rightCols(set_ups).transpose() * left);

    fit.set_ups.resize(stations_.size());
    std::vector<double> counts(stations_.size()), gravity_mgal(stations_.size()),
        readings(stations_.size());
    const Eigen::VectorXd temperature = means_.of(record_.temperature.series.values());
    for (std::size_t i = 0; i < record_.bins.size(); ++i) {
        const DayBin& bin = record_.bins[i];
        DaySetUp& set_up = fit.set_ups[bin.set_up];
        const auto row = static_cast<Index>(i);
        const auto n = static_cast<double>(bin.times.size());
        counts[bin.set_up] += n;
        readings[bin.set_up] += n * readings_mgal_(row);
        set_up.temperature = set_up.temperature + DegC(n * temperature(row));
        set_up.rate_degc_per_h += n * x(row, static_cast<Index>(DayTerm::fast));
        for (std::size_t k = 0; k < kDayTerms; ++k) {
            const auto term = static_cast<Index>(k);
            set_up.effect_mgal.at(k) += n * coefficients(term) * x(row, term);
        }
    }
    for (std::size_t s = 0; s < stations_.size(); ++s) {
        DaySetUp& set_up = fit.set_ups[s];
        if (counts[s] == 0.0) continue;
        const DayStation& station = stations_[s];
        const double base =
            station.gravity ? station.gravity->value() : rough_mgal_[station.unknown];
        const double gravity = station.gravity ? base : fit.unknown_mgal[station.unknown].value;
        set_up.has_bins = true;
        set_up.reading = MilliGal(base + readings[s] / counts[s]) + station.tide;
        set_up.temperature = DegC(set_up.temperature.value() / counts[s]);
        set_up.rate_degc_per_h /= counts[s];
        double effects = 0.0;
        for (double& effect : set_up.effect_mgal) effects += effect /= counts[s];
        set_up.corrected = MilliGal(gravity + placements(static_cast<Index>(s)));
        set_up.flicker = set_up.reading - station.tide - MilliGal(effects) - set_up.corrected;
    }
    return fit;
}

}  // namespace

std::string_view day_term_name(DayTerm term) {
    constexpr std::array<std::string_view, kDayTerms> kNames{"constant_mgal",
                                                             "temperature_mgal_per_degc",
                                                             "slow_temperature_mgal_per_degc",
                                                             "rate_mgal_per_degc_per_h",
                                                             "time_mgal_per_h",
                                                             "warm_up_mgal",
                                                             "x_mgal_per_g",
                                                             "y_mgal_per_g"};
    return kNames.at(static_cast<std::size_t>(term));
}

std::optional<DayFit> fit_day(const DayRecord& record, const std::vector<DayStation>& stations,
                              const DayFit* nearby) {
    const bool is_held = std::any_of(record.bins.begin(), record.bins.end(), [&](const auto& bin) {
        return stations[bin.set_up].gravity.has_value();
    });
    if (!is_held) return std::nullopt;
    const DayProblem problem(record, stations);
    return problem.fit_at(
        problem.most_likely(nearby != nullptr ? std::optional(nearby->point) : std::nullopt));
}

}  // namespace a351::corrector
