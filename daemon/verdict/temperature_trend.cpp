#include "daemon/verdict/temperature_trend.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace a351::daemon {
namespace {

constexpr double kMeanSeconds = 20.0;
constexpr double kAheadSeconds = 600.0;  ///< An occupation.
constexpr double kBendSeconds = 180.0;   ///< A tenth of the body's time constant can be seen.
constexpr double kLeastCoverage = 0.8;   ///< Of the history.
constexpr double kSecondsPerHour = 3600.0;

struct Course {
    Eigen::VectorXd c;  ///< a, b, c / 2, d, e; seconds.
    double w = 0.0;

    [[nodiscard]] static Eigen::RowVectorXd row(double t, double w) {
        Eigen::RowVectorXd r(5);
        r << 1.0, t, t * t, std::cos(w * t), std::sin(w * t);
        return r;
    }
    [[nodiscard]] double at(double t) const { return row(t, w) * c; }
    [[nodiscard]] double trend(double t) const { return c[0] + t * (c[1] + t * c[2]); }
    [[nodiscard]] double rate(double t) const { return c[1] + 2.0 * t * c[2]; }
};

/// @param times_s, degc  of equal length, >= 5.
Course fit_course(const std::vector<double>& times_s, const std::vector<double>& degc,
                  double cycle_s) {
    Course course;
    course.w = 2.0 * std::numbers::pi / cycle_s;
    const auto n = static_cast<Eigen::Index>(times_s.size());
    Eigen::MatrixXd design(n, 5);
    for (Eigen::Index i = 0; i < n; ++i) {
        design.row(i) = Course::row(times_s[static_cast<std::size_t>(i)], course.w);
    }
    const Eigen::Map<const Eigen::VectorXd> y(degc.data(), n);
    course.c = design.colPivHouseholderQr().solve(y);
    return course;
}

}  // namespace

TemperatureTrend::TemperatureTrend(const VerdictOptions& options) : options_(options) {}

void TemperatureTrend::clear() {
    means_.clear();
    count_ = 0;
    sum_degc_ = 0.0;
    outlook_.reset();
}

double TemperatureTrend::known_min() const noexcept {
    if (means_.empty()) return 0.0;
    return (seconds_between(means_.front().time, means_.back().time) + kMeanSeconds) / 60.0;
}

void TemperatureTrend::take(UtcTime time, DegC temperature) {
    if (!means_.empty() && time <= means_.back().time) clear();
    if (count_ > 0 && seconds_between(begun_, time) >= kMeanSeconds) close_mean();
    if (!std::isfinite(temperature.value())) return;
    if (count_ == 0) begun_ = time;
    sum_degc_ += temperature.value();
    ++count_;
}

void TemperatureTrend::close_mean() {
    const Mean mean{begun_ + from_seconds(0.5 * kMeanSeconds), sum_degc_ / count_};
    sum_degc_ = 0.0;
    count_ = 0;
    const double since_s = means_.empty() ? 0.0 : seconds_between(means_.back().time, mean.time);
    if (!slow_degc_) slow_degc_ = mean.degc;
    *slow_degc_ +=
        (1.0 - std::exp(-since_s / (60.0 * options_.slow_lag_min))) * (mean.degc - *slow_degc_);
    means_.push_back(mean);
    const double kept_s = 60.0 * options_.history_min;
    while (seconds_between(means_.front().time, mean.time) >= kept_s) means_.pop_front();
    const double coverage = static_cast<double>(means_.size()) * kMeanSeconds / kept_s;
    const bool is_whole = known_min() >= kLeastCoverage * options_.history_min;
    outlook_ = is_whole && coverage >= kLeastCoverage ? fit() : std::nullopt;
}

std::optional<TemperatureOutlook> TemperatureTrend::fit() const {
    std::vector<double> times_s, degc;
    const UtcTime now = means_.back().time;
    const double zero_degc = means_.front().degc;
    for (const Mean& mean : means_) {
        times_s.push_back(seconds_between(now, mean.time));
        degc.push_back(mean.degc - zero_degc);
    }
    const Course course = fit_course(times_s, degc, options_.cycle_s);

    TemperatureOutlook outlook;
    outlook.slope_degc_per_h = course.rate(0.0) * kSecondsPerHour;
    outlook.curvature_degc_per_h2 = 2.0 * course.c[2] * kSecondsPerHour * kSecondsPerHour;
    // From here on the rate falls as the box takes a step of the air; of the curvature, which the
    // cycle's own unrest makes up in part, half is believed.
    const double rate_now = course.rate(0.0), half_curvature = course.c[2];
    const auto rate_at = [&](double t) {
        return std::exp(-t / (60.0 * options_.relax_min)) * (rate_now + half_curvature * t);
    };
    double slow = *slow_degc_ - zero_degc, degc_ahead = 0.0;
    const double slow_gain = 1.0 - std::exp(-kMeanSeconds / (60.0 * options_.slow_lag_min));
    const double slow_now = slow;
    for (double t = kMeanSeconds; t <= kAheadSeconds; t += kMeanSeconds) {
        degc_ahead += kMeanSeconds * rate_at(t - 0.5 * kMeanSeconds);
        slow += slow_gain * (course.trend(0.0) + degc_ahead - slow);
        const double change =
            options_.static_mgal_per_degc * degc_ahead +
            options_.rate_mgal_h_per_degc * kSecondsPerHour * (rate_at(t) - rate_now) +
            options_.slow_mgal_per_degc * (slow - slow_now);
        if (std::abs(change) > std::abs(outlook.change_mgal)) outlook.change_mgal = change;
    }

    // The course up to 3 min ago, continued.
    const auto is_old = [&](double t) { return t <= -kBendSeconds; };
    const auto old_count =
        static_cast<std::size_t>(std::count_if(times_s.begin(), times_s.end(), is_old));
    if (old_count < 10 || old_count == times_s.size()) return outlook;
    const std::vector<double> old_s(times_s.begin(),
                                    times_s.begin() + static_cast<std::ptrdiff_t>(old_count));
    const std::vector<double> old_degc(degc.begin(),
                                       degc.begin() + static_cast<std::ptrdiff_t>(old_count));
    const Course before = fit_course(old_s, old_degc, options_.cycle_s);
    for (std::size_t i = old_count; i < degc.size(); ++i) {
        const double departure = degc[i] - before.at(times_s[i]);
        if (std::abs(departure) > std::abs(outlook.bend_degc)) outlook.bend_degc = departure;
    }
    return outlook;
}

}  // namespace a351::daemon
