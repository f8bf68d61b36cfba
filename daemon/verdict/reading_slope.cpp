#include "daemon/verdict/reading_slope.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace a351::daemon::verdict {
namespace {

constexpr int kLeastInMinute = 15;       ///< Least number of values in a minute: half of them.
constexpr double kKeptSeconds = 2400.0;  ///< Length of the fit: below three cycles, to be recent.
constexpr double kMostRelated = 0.9;     ///< Largest correlation that so few values can determine.

}  // namespace

void ReadingSlope::clear() {
    minutes_.clear();
    slope_.reset();
    sum_mgal_ = 0.0;
    count_ = 0;
}

void ReadingSlope::take(UtcTime time, MilliGal norm) {
    if (!minutes_.empty() && time <= minutes_.back().time) clear();
    if (count_ > 0 && !(seconds_between(begun_, time) < kSecondsPerMinute)) close_minute();
    if (count_ == 0) begun_ = time;
    if (minutes_.empty() && count_ == 0) zero_mgal_ = norm.value();
    sum_mgal_ += norm.value() - zero_mgal_;
    ++count_;
}

void ReadingSlope::close_minute() {
    if (count_ >= kLeastInMinute) {
        minutes_.push_back({begun_ + from_seconds(0.5 * kSecondsPerMinute), sum_mgal_ / count_});
        const double kept_s = std::max(kKeptSeconds, kSecondsPerMinute * options_.history_min);
        while (seconds_between(minutes_.front().time, minutes_.back().time) >= kept_s)
            minutes_.pop_front();
        slope_ = fit();
    }
    sum_mgal_ = 0.0;
    count_ = 0;
}

std::optional<Slope> ReadingSlope::fit() const {
    const auto n = static_cast<Eigen::Index>(minutes_.size());
    if (static_cast<double>(n) < options_.history_min) return std::nullopt;
    Eigen::MatrixXd design(n, 4);
    Eigen::VectorXd mgal(n);
    const double w = 2.0 * std::numbers::pi / options_.cycle_s;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Minute& minute = minutes_[static_cast<std::size_t>(i)];
        const double t = seconds_between(minutes_.back().time, minute.time);
        design.row(i) << 1.0, t / kSecondsPerHour, std::cos(w * t), std::sin(w * t);
        mgal[i] = minute.mgal;
    }
    const Eigen::Matrix4d inverse = (design.transpose() * design).inverse();
    const Eigen::Vector4d found = inverse * (design.transpose() * mgal);
    const Eigen::VectorXd residual = mgal - design * found;
    const double square = residual.squaredNorm();
    const double related =
        square > 0.0 ? residual.head(n - 1).dot(residual.tail(n - 1)) / square : 0.0;
    const double rho = std::clamp(related, 0.0, kMostRelated);
    const double variance = square / static_cast<double>(n - 4) * (1.0 + rho) / (1.0 - rho);
    return Slope{found[1], std::sqrt(variance * inverse(1, 1))};
}

}  // namespace a351::daemon::verdict
