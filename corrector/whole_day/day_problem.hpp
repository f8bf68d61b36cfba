#pragma once
/// @file
/// The whole-day model as a regression whose columns depend on the lags, and the likelihood of lags
/// and noise.
///
/// It is a part of fit_day().  A point u has eight numbers: both lags, placement, flicker, white
/// noise, the size of the axis biases, and lag and size of an outer oven's effect, each in standard
/// deviations from its prior.  For a fixed point the model is linear:
///
///     const DayProblem problem(record, stations, priors);
///     const DayProblem::Point u = problem.most_likely(std::nullopt);
///     Eigen::MatrixXd columns = problem.scaled(u);         // readings, then columns
///     whiten(record.bins, problem.noise(u), columns);
///     // (X'X + 1)^-1 X'y of the whitened columns: scaled coefficients
///     problem.unscaled(u, scaled_coefficients);            // in the units of the terms
///
/// T0, t and t0 are those of day_model.hpp: 42.5 degC, the time since the first sample of the
/// temperature, and the middle between the first and the last bin.  The order of set-ups and bins
/// that day_model.hpp requires is not checked here either.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "corrector/whole_day/lag_states.hpp"

namespace a351::corrector::whole_day {

/// Standard deviation of the constant, and of the gravity of a station of which nothing is known,
/// mGal: practically no prior.
inline constexpr double kFreeGravity_mgal = 1e4;

/// kDayLags and kDayTerms as sizes of matrices.
inline constexpr auto kLags = static_cast<Eigen::Index>(kDayLags);
inline constexpr auto kTerms = static_cast<Eigen::Index>(kDayTerms);

/// Number of slopes of an outer oven: oA, oS.
inline constexpr Eigen::Index kOuterSlopes = 2;

/// Places in DayFit::Point.  kFastLag and kSlowLag are also places in DayPriors.
enum DayHyper : std::size_t {
    kFastLag,
    kSlowLag,
    kPlacement,
    kFlicker,
    kWhite,
    kBiasSize,
    kOuterLag,
    kOuterSize
};

/// Readings and columns of fit_day() for n bins.  The estimated quantities are the terms, then the
/// gravities, then the steps, then for each gap of the temperature the effects of the fast and of
/// the slow lag's state, mGal where the gap ends (lag_states.hpp), then the slopes of an outer oven.
/// A reference that is held with an uncertainty is one of the gravities, with that prior; an exact one
/// is none.
///
/// An unknown gravity counts from a rough one: the mean of its readings minus the mean constant of
/// the set-ups that are held.  Therefore its prior, 0 +- 1e4 mGal, has practically no influence.
///
/// The column of the scale has the rough gravities of the unknowns.  Therefore the estimate of an
/// unknown is (1 + k) (gravity - rough gravity).
///
/// Accuracy: day_model_test.cpp, through fit_day(); the class has no test of its own.
/// station_system_test.cpp: ln(placement) of 20 made-up days scatters by 0.5 to 1.6 of
/// noise_log_errors().
///
/// All numbers of the record must be finite; this is not checked.
/// Constant members may be called from several threads at a time.
class DayProblem {
public:
    using Point = DayFit::Point;

    /// All arguments are kept by reference and must exist as long as this object.
    /// @param record, stations, priors  as fit_day(); at least one set-up that is held has a bin.
    /// @param rough_mgal  gravities from which the unknown ones count, by number; empty: from the
    ///                    readings.  Then no set-up need be held.
    DayProblem(const reading::DayRecord& record, const std::vector<DayStation>& stations,
               const DayPriors& priors, const std::vector<double>& rough_mgal = {});

    /// Returns the number of terms, gravities, states and slopes of an outer oven.
    [[nodiscard]] Eigen::Index estimated() const {
        return outer_begin() + (has_outer() ? kOuterSlopes : 0);
    }
    [[nodiscard]] bool has_outer() const { return record_.outer.has_value(); }
    /// Returns the place of the first slope of an outer oven, after the states.
    [[nodiscard]] Eigen::Index outer_begin() const {
        return states_begin() + states_sd_mgal_.size();
    }
    /// Returns the number of parameters of a point that are searched; the others are those of an outer
    /// oven.
    [[nodiscard]] std::size_t searched() const { return has_outer() ? Point{}.size() : kOuterLag; }
    /// Returns the place of the first state after a gap.
    [[nodiscard]] Eigen::Index states_begin() const { return kTerms + gravity_sd_mgal_.size(); }
    /// Returns the place of the first step, in front of the states.
    [[nodiscard]] Eigen::Index steps_begin() const { return states_begin() - step_count_; }
    /// Returns the place of a station's gravity among the estimated quantities; -1 if a reference
    /// without uncertainty is held.
    /// @param number  as DayStation::number.
    [[nodiscard]] Eigen::Index place_of(std::size_t number) const { return places_[number]; }

    /// Returns the estimates (estimated) in the units of the terms: a linear function of the
    /// point's lags and of the scaled coefficients.
    ///
    /// An estimate is mean + factor x (lags, coefficients) of the priors.  The lags take part
    /// because a prior may correlate them with slopes.  A gravity counts from base_mgal().
    /// @param scaled  (estimated) coefficients of scaled().
    [[nodiscard]] Eigen::VectorXd unscaled(const Point& u, const Eigen::VectorXd& scaled) const;
    /// Returns the derivative of unscaled() (estimated, estimated + 2); the lags are last.
    [[nodiscard]] Eigen::MatrixXd unscaling(const Point& u) const;

    /// Returns the scale factor.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] static double scale(const Eigen::VectorXd& values) {
        return 1.0 + values(static_cast<Eigen::Index>(DayTerm::scale));
    }

    /// Returns the noise at a point.  The median of white noise is the scatter between neighbouring
    /// bins of a set-up, at least 1e-3 mGal; 1 mGal if no set-up has two bins.
    [[nodiscard]] DayNoise noise(const Point& u) const;

    /// Returns the point with this noise, and with the medians of all other parameters.
    /// @param noise  each part > 0.
    [[nodiscard]] Point point_of(const DayNoise& noise) const;

    /// Returns the point with the roots of the expected variances of placement, flicker, axis biases
    /// and an outer oven's effect; the rest as in `u`.
    ///
    /// They are larger than the most likely ones, because the distribution is skew.  It is taken as
    /// log-normal, with the variance from the curvature of the cost.
    /// @param u  most likely point.  Elsewhere the curvature means nothing.
    [[nodiscard]] Point expected(const Point& u) const;
    /// Returns ln of the factor of one deviation.
    /// @param part  placement, flicker, size of the axis biases or of an outer oven's effect.
    [[nodiscard]] double log_factor(DayHyper part) const;
    /// Returns the standard errors of the logarithms of placement, flicker and white noise, from the
    /// curvature of the cost with the other numbers held; absent if it has no minimum there.
    /// @param u  most likely point.
    [[nodiscard]] std::optional<std::array<double, 3>> noise_log_errors(const Point& u) const;
    /// Returns a lag at a point, s.
    /// @param lag  kFastLag or kSlowLag.
    [[nodiscard]] double lag_s(const Point& u, DayHyper lag) const;

    /// Returns the point with the least cost, on the grid of search_point(), at most 12 standard
    /// deviations of the priors away.
    ///
    /// It evaluates cost() at most 2000 times and does not report if this was too few.
    /// @param nearby  start of the search; absent: the priors' medians, with the size of the axis
    ///                biases of 0, 2 and 4 deviations that has the least cost.
    [[nodiscard]] Point most_likely(const std::optional<Point>& nearby) const;

    /// Returns -ln(restricted likelihood x priors), up to a constant; infinite if it overflows.
    ///
    /// Differences between points are meaningful, the value itself is not.  Cost: one lag filter of
    /// the temperature for each lag, then O(n (1 + estimated)^2).
    [[nodiscard]] double cost(const Point& u) const { return cost(u, scaled(u)); }

    /// Returns the columns (n, estimated) in the units of the terms: derivatives of the readings by
    /// the terms, then 1 for the bins of each gravity and for those after each step, then what remains of
    /// each state, then the outer oven's temperature without and with its lag.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u) const;

    /// Returns (n, 1 + estimated): readings minus their prior expectation, then the columns of
    /// coefficients whose priors are independent and of variance 1.
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u) const;

    /// Returns the derivatives of the readings by the point's lags (n, 2), mGal per standard
    /// deviation of the prior.  With them as further columns, the errors of the lags enter those of
    /// the terms.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] Eigen::MatrixXd lag_columns(const Point& u, const Eigen::VectorXd& values) const;

    /// Returns the object that averages a series over the bins.  The reference is valid as long as
    /// this object.
    [[nodiscard]] const BinMeans& means() const { return means_; }
    /// Returns the readings (n) minus tide and base_mgal().
    [[nodiscard]] const Eigen::VectorXd& readings_mgal() const { return readings_mgal_; }
    /// Returns the gravity of each station from which its estimate counts, mGal: the reference, or a
    /// rough value; 0 for a number without a bin.
    [[nodiscard]] const std::vector<double>& base_mgal() const { return base_mgal_; }

    /// Returns the response to an outer oven; std::nullopt without one.
    /// @param values, errors  (estimated) from unscaled(), and their standard errors.
    [[nodiscard]] std::optional<OuterResponse> outer_response(const Point& u,
                                                              const Eigen::VectorXd& values,
                                                              const Eigen::VectorXd& errors) const;

    /// Returns the problem linearised at a fit: columns (n, estimated + 2) of coefficients whose
    /// priors are independent and of variance 1, the lags last, whitened with the expected noise.
    /// Their normal matrix plus 1 is the inverse of the posterior covariance.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] Eigen::MatrixXd linearised(const Point& expected,
                                             const Eigen::VectorXd& values) const;

private:
    /// The columns of two lags, kept from point to point of a search: many points differ in one of
    /// them or in neither.
    struct LagColumns {
        double fast_s = 0.0, slow_s = 0.0;  ///< Their lags; 0: none yet.
        Eigen::VectorXd fast, slow;
    };

    void set_gravities();
    void set_readings(const std::vector<double>& rough_mgal);
    void set_fixed_columns();
    void set_states();
    [[nodiscard]] Eigen::VectorXd fast_column(double lag_s) const;
    [[nodiscard]] Eigen::VectorXd slow_column(double lag_s) const;
    /// design() and scaled(); columns of other lags are computed and kept in `lagged`.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u, LagColumns& lagged) const;
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u, LagColumns& lagged) const;
    /// Returns cost(u) from the scaled() columns of a point that differs from `u` in its noise only.
    [[nodiscard]] double cost(const Point& u, Eigen::MatrixXd columns) const;
    /// Returns the columns (n, kOuterSlopes) of an outer oven, without their means.
    [[nodiscard]] Eigen::MatrixXd outer_columns(const Point& u) const;
    /// Returns the priors' factor of lags and terms, with the size of the axis biases at a point.
    [[nodiscard]] DayPriors::Matrix prior_factor(const Point& u) const;

    const reading::DayRecord& record_;
    const std::vector<DayStation>& stations_;
    const DayPriors& priors_;
    std::vector<bool> is_held_;         ///< One per number: one of its set-ups has a reference.
    std::vector<Eigen::Index> places_;  ///< place_of() each number.
    /// Prior deviations of the gravities that are estimated, then of the steps.
    Eigen::VectorXd gravity_sd_mgal_;
    Eigen::Index step_count_ = 0;
    std::vector<LagStates> states_;   ///< One per gap whose effect matters.
    Eigen::VectorXd states_sd_mgal_;  ///< Prior deviations of the effects, fast and slow per gap.
    BinMeans means_;
    Whitening whitening_;
    LogNormalPrior white_mgal_;
    std::vector<double> base_mgal_;
    Eigen::VectorXd readings_mgal_;
    Eigen::MatrixXd fixed_;  ///< All columns of design(); 0 where one depends on the lags.
};

}  // namespace a351::corrector::whole_day
