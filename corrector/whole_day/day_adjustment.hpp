#pragma once
/// @file
/// An adjustment of survey days at its most likely lags and noise: one linear system, in which any
/// references can be hidden.
///
///     const DayAdjustment adjustment = adjust_day({&record, stations}).value();
///     adjustment.gravity(3);         // of station 3, with its reference if it is held
///     adjustment.left_out(3);        // what the instrument measured: with its reference hidden
///     adjustment.difference(3, 5);   // gravity of station 5 minus that of station 3
///     adjustment.fit();              // coefficients, set-ups
///
/// Values are those of least squares with the most likely noise.  What a hidden reference changes, and
/// all errors, are those with the expected noise, which is larger, so that a change and its error belong
/// to one system; a change of the lags enters to first order.
///
/// The error of an estimate is a sum of independent errors of variance 1: those of the whitened
/// readings and those of the priors.  Two estimates from different sets of references have
/// their errors in common, and so a covariance.  With X the columns of all gravities, held and free,
/// and s = (x'x + 1)^-1 wanted of the columns x that a set of references has:
///
///     covariance of two estimates = s1' (X'X + 1) s2
///
/// Only X'X is needed.  Columns that every set of references has can be eliminated from it first.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "corrector/whole_day/day_fit.hpp"
#include "corrector/whole_day/day_search.hpp"

namespace a351::corrector::whole_day {

/// An adjustment of one or more surveys.  Constant members may be called from several threads at a time.
class DayAdjustment {
public:
    DayAdjustment(std::shared_ptr<const DayProblem> problem, DaySearch found);

    [[nodiscard]] const DayProblem& problem() const { return *problem_; }
    /// Returns the share of the placement that a box has in common; absent without a box.
    [[nodiscard]] const std::optional<PlacementShare>& share() const { return found_.share; }
    [[nodiscard]] bool is_held(std::size_t number) const { return gravities_[number].is_held; }

    /// Returns the value of a gravity, all references held, mGal.
    [[nodiscard]] double value_mgal(std::size_t number) const {
        return gravities_[number].fitted_mgal;
    }
    /// Returns the same with its error.
    [[nodiscard]] GravityEstimate gravity(std::size_t number) const;

    /// Returns gravity of station `to` minus gravity of `from`, mGal, with the references of both
    /// hidden and all others held.
    ///
    /// Accuracy (day_adjustment_test.cpp): on made-up days of ten stations the value is within
    /// 0.1 mGal, and the standard error within 10 %, of a fit without both references.  On simulated
    /// days differences scatter as stated (tests/bench/differences.py).
    /// @param from, to  two different numbers.
    [[nodiscard]] Estimate difference(std::size_t from, std::size_t to) const;

    /// Returns the gravity of a station with its own reference hidden and all others held; if it alone
    /// is held, the reference with its uncertainty.
    ///
    /// Accuracy (day_adjustment_test.cpp): as difference().
    [[nodiscard]] GravityEstimate left_out(std::size_t number) const;

    /// Returns the correlation (stations, stations) of the errors of all gravities, each estimated
    /// with its own reference hidden, in order of their numbers.  If only one is held, it stays held;
    /// its row is 0 if it has no uncertainty.
    ///
    /// It is positive semidefinite, because it is that of sums of independent errors.
    [[nodiscard]] Eigen::MatrixXd correlation() const;

    /// Returns DaySetUp::corrected: gravity and the expected placement of a set-up.
    [[nodiscard]] MilliGal corrected(std::size_t set_up, std::size_t survey = 0) const;
    /// Returns the most likely noise of a survey.
    [[nodiscard]] DayNoise noise(std::size_t survey = 0) const;
    /// Returns the roots of its expected variances.
    [[nodiscard]] DayNoise expected_noise(std::size_t survey = 0) const;
    /// Returns DayFit::noise_log_errors of a single survey.
    [[nodiscard]] const std::optional<std::array<double, 3>>& noise_log_errors() const {
        return found_.noise_log_errors;
    }

    /// Returns the most likely coefficients of a survey, as those of DayRegression::scaled().
    [[nodiscard]] const Eigen::VectorXd& scaled(std::size_t survey) const {
        return surveys_[survey].scaled;
    }
    /// Returns the result of the adjustment for a survey.
    [[nodiscard]] DayFit fit(std::size_t survey = 0) const;

private:
    using Index = Eigen::Index;

    /// The gravity of a station.  A column is -1 if there is none.
    struct Gravity {
        double fitted_mgal = 0.0;
        double scale = 1.0;  ///< 1 + k of a unit that was there; estimates are 1 + k times gravity.
        bool is_held = false;
        double u_mgal = 0.0;  ///< Uncertainty of the reference that is held.
        Index held = -1;      ///< Column of the fit: of an unknown, or an uncertain reference.
        Index own = -1;       ///< Column without prior knowledge; of an unknown the same.
        /// Holds the reference of a station, if it is held.
        void hold(const DayStation& station) {
            if (!station.gravity) return;
            is_held = true;
            u_mgal = station.u_gravity.value();
        }
    };
    void set_columns();
    /// Returns the expected placement of each set-up, placement^2 M' C^-1 r: C is the covariance of the
    /// most likely noise, r the residuals; M(i, s) = 1 if bin i belongs to set-up s, else 0.
    [[nodiscard]] Eigen::VectorXd placement_mgal(std::size_t survey,
                                                 const Eigen::MatrixXd& scaled) const;
    void set_gravities();
    /// Returns the solution of the system without the references of some stations, which are held.
    /// @param right  (common columns) 0 for columns that the fit lacks, except `own` of the hidden.
    [[nodiscard]] Eigen::VectorXd solved(const std::vector<std::size_t>& hidden,
                                         const Eigen::VectorXd& right) const;
    /// Returns the references to hide for a gravity's own value: its own, unless it alone is held.
    [[nodiscard]] std::vector<std::size_t> hidden_for(std::size_t number) const;
    /// Returns a gravity, in deviations of its columns in the system.
    [[nodiscard]] Eigen::VectorXd wanted(std::size_t number,
                                         const std::vector<std::size_t>& hidden) const;
    [[nodiscard]] GravityEstimate estimate(std::size_t number,
                                           const std::vector<std::size_t>& hidden) const;
    /// Returns the standard error of an estimate from its parts of the columns, mGal.
    [[nodiscard]] double error_mgal(const Eigen::VectorXd& parts) const;
    /// Returns the parts of SurveyPart::columns.
    [[nodiscard]] Eigen::VectorXd parts_of(const Eigen::VectorXd& common, std::size_t survey) const;
    [[nodiscard]] Eigen::VectorXd parts_of_group(const Eigen::VectorXd& common,
                                                 std::size_t group) const;
    void set_sources(GravityEstimate& gravity, const Eigen::VectorXd& parts) const;
    /// Returns the covariance of a survey's coefficients, the lags last.
    [[nodiscard]] Eigen::MatrixXd covariance_of(std::size_t survey) const;
    [[nodiscard]] std::vector<DaySetUp> set_ups_of(std::size_t survey) const;

    /// Columns that only a group has.
    struct GroupPart {
        Eigen::MatrixXd answer;  ///< (own, common) Change of the own columns with the common ones.
        Eigen::MatrixXd covariance;        ///< (own, own) With the common ones known.
        std::vector<ErrorSource> sources;  ///< Sources of the priors of the own columns.
    };
    /// The equations of a survey at the expected noise.
    struct SurveyPart {
        Eigen::VectorXd scaled, values;  ///< Most likely coefficients; in the units of the terms.
        Eigen::MatrixXd columns;         ///< (bins, columns) Whitened, as DayProblem::whitened().
        Eigen::VectorXd left;            ///< (bins) Whitened residuals.
        Eigen::VectorXd placement_mgal;  ///< Expectation for each set-up, given all readings.
    };

    std::shared_ptr<const DayProblem> problem_;
    DaySearch found_;
    std::vector<SurveyPart> surveys_;
    std::vector<GroupPart> groups_;
    std::vector<ErrorSource> sources_;  ///< Sources of the priors of the common columns.
    Eigen::MatrixXd information_;       ///< (common, common) X'X + 1.
    Eigen::MatrixXd
        covariance_;          ///< Covariance of the coefficients of the common columns of the fit.
    Eigen::VectorXd common_;  ///< Most likely coefficients of the common columns of the fit.
    Eigen::VectorXd gradient_;  ///< (common) 0 for the columns of the fit.
    std::vector<Gravity> gravities_;
};

}  // namespace a351::corrector::whole_day
