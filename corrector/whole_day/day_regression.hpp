#pragma once
/// @file
/// The whole-day model as a regression whose columns depend on the lags.
///
/// It is a part of fit_day(); DayProblem adds noise and likelihood.  A point u has eight numbers: both
/// lags, placement, flicker, white noise, the size of the axis biases, and lag and size of an outer
/// oven's effect, each in standard deviations from its prior.  For a fixed point the model is linear.
/// The regression depends on all numbers but those of the noise.
///
/// T0, t and t0 are those of day_model.hpp: 42.5 degC, the time since the first sample of the
/// temperature, and the middle between the first and the last bin.  The order of set-ups and bins
/// that day_model.hpp requires is not checked here either.

#include <Eigen/Core>
#include <cstddef>
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

/// Prior of the slopes of an outer oven.  Assumed, because nobody has measured a double oven: the wall
/// hardly acts, or up to as much as the sensor's own slow response (two deviations are 27 mGal/degC).
inline constexpr LogNormalPrior kOuterSize_mgal_per_degc{3.0, 3.0};

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
///
/// All numbers of the record must be finite; this is not checked.
/// Constant members may be called from several threads at a time.
class DayRegression {
public:
    using Point = DayFit::Point;

    /// All arguments are kept by reference and must exist as long as this object.
    /// @param record, stations, priors  as fit_day(); at least one set-up that is held has a bin.
    /// @param rough_mgal  gravities from which the unknown ones count, by number; empty: from the
    ///                    readings.  Then no set-up need be held.
    DayRegression(const reading::DayRecord& record, const std::vector<DayStation>& stations,
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

    /// Returns a lag at a point, s.
    /// @param lag  kFastLag or kSlowLag.
    [[nodiscard]] double lag_s(const Point& u, DayHyper lag) const;

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

protected:
    /// The columns of two lags, kept from point to point of a search: many points differ in one of
    /// them or in neither.
    struct LagColumns {
        double fast_s = 0.0, slow_s = 0.0;  ///< Their lags; 0: none yet.
        Eigen::VectorXd fast, slow;
    };

    /// scaled(); columns of other lags are computed and kept in `lagged`.
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u, LagColumns& lagged) const;

    [[nodiscard]] const DayPriors& priors() const { return priors_; }

private:
    void set_gravities();
    void set_readings(const std::vector<double>& rough_mgal);
    void set_fixed_columns();
    void set_states();
    [[nodiscard]] Eigen::VectorXd fast_column(double lag_s) const;
    [[nodiscard]] Eigen::VectorXd slow_column(double lag_s) const;
    /// design(), as scaled().
    [[nodiscard]] Eigen::MatrixXd design(const Point& u, LagColumns& lagged) const;
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
    std::vector<double> base_mgal_;
    Eigen::VectorXd readings_mgal_;
    Eigen::MatrixXd fixed_;  ///< All columns of design(); 0 where one depends on the lags.
};

}  // namespace a351::corrector::whole_day
