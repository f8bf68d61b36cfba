#pragma once
/// @file
/// The whole-day model as a regression whose columns depend on the lags.
///
/// At a fixed point the model is linear.  The columns depend on all numbers of the point but those of
/// the noise:
///
///     const DayRegression regression(survey);
///     Eigen::MatrixXd columns = regression.scaled(u);      // readings, then columns
///     regression.whiten(regression.noise(u), columns);
///     // (X'X + 1)^-1 X'y of the whitened columns: scaled coefficients
///     regression.unscaled(u, scaled_coefficients);         // in the units of the terms
///
/// T0, t and t0 are those of day_model.hpp: 42.5 degC, the time since the first sample of the
/// temperature, and the middle between the first and the last bin.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_fit.hpp"
#include "corrector/whole_day/day_survey.hpp"
#include "corrector/whole_day/lag_states.hpp"

namespace a351::corrector::whole_day {

/// Readings and columns of a survey with n bins.  The estimated quantities, in this order:
///
/// - the terms; the gravities; the steps;
/// - for each gap of the temperature the effects of the fast and of the slow lag's state, mGal
///   where the gap ends (lag_states.hpp);
/// - the slopes of an outer oven;
/// - those that act on the scale, if the sensor was turned over.
///
/// A reference that is held with an uncertainty is one of the gravities, with that prior.  An exact
/// reference is not estimated.
///
/// A reading is face x (gravity + scale) + bias, and the norm of the axes is face x this.  All rows are
/// multiplied by the face of their bin, 1 or -1: the columns of the bias are then those of one face,
/// gravities, scale and axes have the sign, and the flicker continues over a turn.
///
/// An unknown gravity counts from a rough one: the mean of its readings minus the mean constant of
/// the set-ups that are held.  Therefore its prior, 0 +- 1e4 mGal, has practically no influence.
///
/// The column of the scale has the rough gravities of the unknowns.  Therefore the estimate of an
/// unknown is (1 + k) (gravity - rough gravity).
///
/// Accuracy: day_model_test.cpp, through adjust_day(); the class has no test of its own.
///
/// All numbers of the record must be finite; this is not checked.
/// Constant members may be called from several threads at a time.
class DayRegression {
public:
    using Point = SurveyPoint;

    /// Terms that have a part that acts on the scale.  The term is the sum of both parts, which is what a
    /// day in one face and a calibration see; two faces show the part on the scale too.  The prior of the
    /// part is the term times the unit's scale_share(), with the deviation share_spread.
    static constexpr std::array kOnScale{DayTerm::level, DayTerm::slow, DayTerm::fast,
                                         DayTerm::drift, DayTerm::warm_up};

    /// @param survey  kept by reference.
    /// @param rough_mgal  gravities from which the unknown ones count, by number; empty: from the
    ///                    readings.  Then a set-up must be held.
    explicit DayRegression(const DaySurvey& survey, const std::vector<double>& rough_mgal = {});

    /// Returns the number of all estimated quantities.
    [[nodiscard]] Eigen::Index estimated() const { return on_scale_begin() + on_scale(); }
    /// Returns the number of parts that act on the scale: those of kOnScale, if the sensor was turned
    /// over.
    [[nodiscard]] Eigen::Index on_scale() const {
        return has_two_faces_ ? std::ssize(kOnScale) : 0;
    }
    /// Returns the place of the first of them, the last of the estimated quantities.
    [[nodiscard]] Eigen::Index on_scale_begin() const {
        return outer_begin() + (has_outer() ? kOuterSlopes : 0);
    }
    [[nodiscard]] bool has_outer() const { return record_.outer.has_value(); }
    /// Returns the place of the first slope of an outer oven, after the states.
    [[nodiscard]] Eigen::Index outer_begin() const {
        return states_begin() + states_sd_mgal_.size();
    }
    /// Returns the place of the first state after a gap.
    [[nodiscard]] Eigen::Index states_begin() const { return kTerms + gravity_sd_mgal_.size(); }
    /// Returns true if nothing is known of a coefficient beforehand.
    [[nodiscard]] bool is_free(Eigen::Index k) const {
        return k == 0 || (k >= kTerms && k < states_begin() &&
                          gravity_sd_mgal_(k - kTerms) == kFreeGravity_mgal);
    }
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

    /// Returns the share of the unit's errors that act on the scale: normal if it was measured, else
    /// evenly from 0 to 1 by its prior.
    [[nodiscard]] double scale_share(const Point& u) const;
    /// Returns the standard error of scale_share().
    /// @param errors  of the point, in deviations.
    [[nodiscard]] double scale_share_error(const Point& u, const Point& errors) const;

    /// Returns a lag at a point, s.
    /// @param lag  kFastLag or kSlowLag.
    [[nodiscard]] double lag_s(const Point& u, DayHyper lag) const;

    /// Returns the columns (n, estimated) in the units of the terms, in this order:
    ///
    /// - derivatives of the readings by the terms;
    /// - the face, for the bins of each gravity and for those after each step;
    /// - the remaining part of each state;
    /// - the outer oven's temperature, without and with its lag;
    /// - the columns of kOnScale times face - 1.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u) const;

    /// Returns (n, 1 + estimated): readings minus their prior expectation, then the columns of
    /// coefficients whose priors are independent and of variance 1.
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u) const;

    /// Returns the noise at a point.  The median of white noise is the scatter between neighbouring
    /// bins of a set-up, at least 1e-3 mGal; 1 mGal if no set-up has two bins.
    [[nodiscard]] DayNoise noise(const Point& u) const;
    /// Returns the point with this noise, and with the medians of all other parameters.
    /// @param noise  each part > 0.
    [[nodiscard]] Point point_of(const DayNoise& noise) const;
    /// Returns ln of the factor of one deviation of a number of a point; of the lags, 0.
    [[nodiscard]] double log_factor(DayHyper part) const;
    /// Whitens columns for the bins of the survey, as whiten() of day_noise.hpp does for any bins.
    double whiten(const DayNoise& noise, Eigen::MatrixXd& columns) const {
        return whitening_.whiten(noise, columns);
    }

    /// Returns the derivatives of the readings by the point's lags (n, 2), mGal per standard
    /// deviation of the prior.  With them as further columns, the errors of the lags enter those of
    /// the terms.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] Eigen::MatrixXd lag_columns(const Point& u, const Eigen::VectorXd& values) const;

    /// Returns the object that averages a series over the bins.  The reference is valid as long as
    /// this object.
    [[nodiscard]] const BinMeans& means() const { return temperature_->means(); }
    /// Returns the readings (n) minus tide and base_mgal(), times the face.
    [[nodiscard]] const Eigen::VectorXd& readings_mgal() const { return readings_mgal_; }
    /// Returns the gravity of each station from which its estimate counts, mGal: the reference, or a
    /// rough value; 0 for a number without a bin.
    [[nodiscard]] const std::vector<double>& base_mgal() const { return base_mgal_; }

    /// Returns the response to an outer oven; std::nullopt without one.
    /// @param values, errors  (estimated) from unscaled(), and their standard errors.
    [[nodiscard]] std::optional<OuterResponse> outer_response(const Point& u,
                                                              const Eigen::VectorXd& values,
                                                              const Eigen::VectorXd& errors) const;

private:
    void set_gravities();
    void set_readings(const std::vector<double>& rough_mgal);
    void set_fixed_columns();
    void set_states();
    /// Returns the columns (n) of the fast and of the slow rate.
    [[nodiscard]] std::array<Eigen::VectorXd, 2> lag_effects(const Point& u) const;
    /// Returns the deviations of the parts that act on the scale, by their priors, if the terms and the
    /// share are known.
    [[nodiscard]] Eigen::VectorXd on_scale_sd() const;
    /// Returns the columns (n, kOuterSlopes) of an outer oven, without their means.
    [[nodiscard]] Eigen::MatrixXd outer_columns(const Point& u) const;
    /// Returns the priors' factor of lags and terms, with the size of the axis biases at a point.
    [[nodiscard]] DayPriors::Matrix prior_factor(const Point& u) const;

    const reading::DayRecord& record_;
    const std::vector<DayStation>& stations_;
    const DayPriors& priors_;
    Whitening whitening_;
    LogNormalPrior white_mgal_;
    bool has_two_faces_;
    Eigen::VectorXd faces_;             ///< Face of each bin.
    std::vector<bool> is_held_;         ///< One per number: one of its set-ups has a reference.
    std::vector<Eigen::Index> places_;  ///< place_of() each number.
    /// Prior deviations of the gravities that are estimated, then of the steps.
    Eigen::VectorXd gravity_sd_mgal_;
    Eigen::Index step_count_ = 0;
    std::vector<LagStates> states_;   ///< One per gap whose effect matters.
    Eigen::VectorXd states_sd_mgal_;  ///< Prior deviations of the effects, fast and slow per gap.
    std::shared_ptr<const LaggedMeans> temperature_;
    std::vector<double> base_mgal_;
    Eigen::VectorXd readings_mgal_;
    Eigen::MatrixXd fixed_;  ///< All columns of design(); 0 where one depends on the lags.
};

}  // namespace a351::corrector::whole_day
