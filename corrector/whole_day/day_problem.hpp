#pragma once
/// @file
/// The whole-day model as a regression whose columns depend on the lags, and the likelihood of lags
/// and noise.

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector {

/// kDayLags and kDayTerms as sizes of matrices.
inline constexpr auto kLags = static_cast<Eigen::Index>(kDayLags);
inline constexpr auto kTerms = static_cast<Eigen::Index>(kDayTerms);

/// Log-normal prior of a standard deviation: median x factor^u with u normal, of variance 1.
struct LogNormalPrior {
    double median = 0.0, factor = 1.0;
    /// Returns median x factor^u.
    [[nodiscard]] double at(double u) const { return median * std::pow(factor, u); }
};

/// Places in DayFit::Point.
enum DayHyper : std::size_t { kFastLag, kSlowLag, kPlacement, kFlicker, kWhite };

/// Readings and columns of fit_day() for n bins.  The estimated quantities are the terms, then the
/// unknowns.
class DayProblem {
public:
    using Point = DayFit::Point;

    /// All arguments are kept by reference and must exist as long as this object.
    /// @param record, stations, priors  as fit_day(); at least one set-up that is held has a bin.
    DayProblem(const DayRecord& record, const std::vector<DayStation>& stations,
               const DayPriors& priors);

    /// Returns the number of terms and unknowns.
    [[nodiscard]] Eigen::Index estimated() const { return kTerms + unknowns_; }

    /// Returns the estimates (estimated) in the units of the terms: a linear function of the
    /// point's lags and of the scaled coefficients.
    /// @param scaled  (estimated) coefficients of scaled().
    [[nodiscard]] Eigen::VectorXd unscaled(const Point& u, const Eigen::VectorXd& scaled) const;
    /// Returns the derivative of unscaled() (estimated, estimated + 2); the lags are last.
    [[nodiscard]] Eigen::MatrixXd unscaling() const;

    /// Returns the noise at a point.
    [[nodiscard]] DayNoise noise(const Point& u) const;

    /// Returns the roots of the expected variances of placement and flicker; white as noise().
    ///
    /// They are larger than the most likely ones, because the distribution is skew.  It is taken as
    /// log-normal, with the variance from the curvature of the cost.
    /// @param u  most likely point.
    [[nodiscard]] DayNoise expected_noise(const Point& u) const;
    /// Returns a lag at a point, s.
    [[nodiscard]] double lag_s(const Point& u, DayHyper lag) const;

    /// Returns the point with the least cost, on the grid of search_point(), at most 12 standard
    /// deviations of the priors away.
    /// @param nearby  start of the search; absent: the priors' medians.
    [[nodiscard]] Point most_likely(const std::optional<Point>& nearby) const;

    /// Returns -ln(restricted likelihood x priors), up to a constant; infinite if it overflows.
    [[nodiscard]] double cost(const Point& u) const;

    /// Returns the columns (n, estimated) in the units of the terms.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u) const;

    /// Returns (n, 1 + estimated): readings minus their prior expectation, then the columns of
    /// coefficients whose priors are independent and of variance 1.
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u) const;

    /// Returns the derivatives of the readings by the point's lags (n, 2), mGal per standard
    /// deviation of the prior.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] Eigen::MatrixXd lag_columns(const Point& u, const Eigen::VectorXd& values) const;

    /// Returns the means over the bins.
    [[nodiscard]] const BinMeans& means() const { return means_; }
    /// Returns the readings (n) minus tide and gravity, held or rough.
    [[nodiscard]] const Eigen::VectorXd& readings_mgal() const { return readings_mgal_; }
    /// Returns the rough gravity of each unknown, to which its estimate is added.
    [[nodiscard]] const std::vector<double>& rough_mgal() const { return rough_mgal_; }

private:
    void set_readings();
    void set_fixed_columns();
    [[nodiscard]] Eigen::VectorXd fast_column(double lag_s) const;
    [[nodiscard]] Eigen::VectorXd slow_column(double lag_s) const;

    const DayRecord& record_;
    const std::vector<DayStation>& stations_;
    const DayPriors& priors_;
    Eigen::Index unknowns_;
    BinMeans means_;
    LogNormalPrior white_mgal_;
    std::vector<double> rough_mgal_;
    Eigen::VectorXd readings_mgal_;
    Eigen::MatrixXd fixed_;  ///< All columns of design(); 0 where one depends on the lags.
};

}  // namespace a351::corrector
