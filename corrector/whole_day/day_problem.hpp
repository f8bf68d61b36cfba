#pragma once
/// @file
/// One adjustment of one or more surveys: the likelihood of their lags and noise, and its linear
/// system.
///
/// The surveys have columns in common, which is all that makes the adjustment joint:
///
/// - of a survey alone: the terms of a loop, steps, states after gaps;
/// - of a unit: the other terms, the lags, and the slopes of an outer oven;
/// - of all: the gravities;
/// - of a box: the part of the placement that all sensors of a set-up have in common.  It is one more
///   unknown for each set-up of the box, with the deviation sqrt(share) placement; the noise of each
///   sensor keeps sqrt(1 - share) placement.
///
/// A *group* is the surveys that have set-ups in common: the sensors of a box on one day; mostly it is
/// one survey.  What only a group has is eliminated in it, so that the cost of a likelihood grows
/// with the number of surveys, and a search that moves one survey computes its group only.  The surveys
/// with white noise are one more group; it depends on no number of the search.

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "corrector/whole_day/day_regression.hpp"

namespace a351::corrector::whole_day {

/// Lags and noise of an adjustment.
struct DayPoint {
    std::vector<double> u;  ///< One for each DayProblem::hypers(), in deviations from its prior.
    double share = 0.0;     ///< Share of the placement's variance that a box has, 0 to 1.
};

/// A number of a point.
struct Hyper {
    DayHyper kind{};
    std::vector<std::size_t> surveys;  ///< Those whose equations it changes.
    /// Returns true if it changes the columns, not only the noise.
    [[nodiscard]] bool is_of_unit() const {
        return kind != kPlacement && kind != kFlicker && kind != kWhite;
    }
};

/// The surveys of an adjustment.  Constant members may be called from several threads at a time.
class DayProblem {
public:
    /// Surveys with set-ups in common.
    struct Group {
        std::vector<std::size_t> surveys;
        /// The group's number of each set-up, by survey.
        std::vector<std::vector<std::size_t>> set_ups;
        std::size_t set_up_count = 0;
        Eigen::Index own_count = 0;  ///< Columns that only the group has.
        /// Products of the white surveys' readings, as of_group() with is_extended; empty: none.
        Eigen::MatrixXd of_white_surveys = {};
        [[nodiscard]] bool is_box() const { return surveys.size() > 1; }
    };
    /// Products of whitened columns, and ln det of what is integrated out of them: noise, own columns.
    struct Normal {
        Eigen::MatrixXd products;
        double log_determinant = 0.0;
    };

    /// @param surveys     at least one, or a white survey.
    /// @param rough_mgal  gravity from which each unknown counts, by number in the adjustment.  Empty:
    ///                    from the readings; then there is one survey, of which a set-up is held.
    explicit DayProblem(std::vector<DaySurvey> surveys, std::vector<double> rough_mgal = {},
                        std::vector<WhiteSurvey> white_surveys = {});
    DayProblem(const DayProblem&) = delete;
    DayProblem& operator=(const DayProblem&) = delete;
    ~DayProblem() = default;

    [[nodiscard]] const std::vector<DaySurvey>& surveys() const { return surveys_; }
    [[nodiscard]] const std::vector<WhiteSurvey>& white_surveys() const { return white_surveys_; }
    [[nodiscard]] const DayRegression& of(std::size_t survey) const {
        return *regressions_[survey];
    }
    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
    [[nodiscard]] std::size_t group_of(std::size_t survey) const { return group_of_[survey]; }
    /// Returns true if a group has several sensors, so that the share matters.
    [[nodiscard]] bool has_boxes() const;
    /// Returns the part of a set-up's placement that a box has in common, mGal; 0 without a box.
    /// @param of_box  coefficients of the set-ups of the box.
    [[nodiscard]] double in_common_mgal(const DayPoint& point, std::size_t survey,
                                        std::size_t set_up, const Eigen::VectorXd& of_box) const;

    /// Returns the numbers of a point: the lags of each unit, the placement of each group, flicker
    /// and white noise of each survey.  For each unit the size of the axis biases follows.  Lag and
    /// size of an outer oven's effect are last, if one of the unit's surveys has its temperature.
    [[nodiscard]] const std::vector<Hyper>& hypers() const { return hypers_; }
    /// Returns a survey's part of a point; 0 where it has none.
    [[nodiscard]] SurveyPoint part_of(const DayPoint& point, std::size_t survey) const;
    /// Returns the noise of a survey's readings; of the placement only the sensor's part.
    [[nodiscard]] DayNoise own_noise(const DayPoint& point, std::size_t survey) const;

    /// Returns the number of gravities.
    [[nodiscard]] std::size_t gravity_count() const { return places_.size(); }
    /// Returns the number of a survey's gravity in the adjustment.
    [[nodiscard]] std::size_t gravity_of(std::size_t survey, std::size_t number) const;
    /// Returns the number of columns that groups have in common.
    [[nodiscard]] Eigen::Index common_count() const { return common_count_; }
    /// Returns the common column of a gravity; -1 if an exact reference is held.
    [[nodiscard]] Eigen::Index place_of(std::size_t gravity) const { return places_[gravity]; }
    /// Returns the gravity from which the station of a white survey counts, mGal.
    [[nodiscard]] double base_mgal(const DayStation& station) const {
        return station.gravity ? station.gravity->value() : rough_mgal_[station.number];
    }
    /// Returns the further common column of a gravity without its reference.
    [[nodiscard]] Eigen::Index own_place_of(std::size_t gravity) const {
        return common_count_ + static_cast<Eigen::Index>(gravity);
    }
    /// Returns the place of each column of a survey in its group's products: the readings, the columns
    /// of DayRegression::scaled(), the set-ups of a box, the lags, the gravities without reference.
    /// @param is_extended  with the last two.
    [[nodiscard]] std::vector<Eigen::Index> places_in_group(std::size_t survey,
                                                            bool is_extended) const;

    /// Returns the whitened columns of a survey in this order.
    /// @param scaled  DayRegression::scaled() of the survey at the point.
    /// @param values  null: it is not extended.  Else the estimates of the survey, for the columns of
    ///                its lags.
    /// @param log_determinant  receives that of the noise's covariance.
    [[nodiscard]] Eigen::MatrixXd whitened(const DayPoint& point, std::size_t survey,
                                           const Eigen::MatrixXd& scaled,
                                           const Eigen::VectorXd* values,
                                           double& log_determinant) const;
    /// Returns the products of whitened().
    [[nodiscard]] Normal of_survey(const DayPoint& point, std::size_t survey,
                                   const Eigen::MatrixXd& scaled,
                                   const Eigen::VectorXd* values = nullptr) const;
    /// Returns the products of a group's columns: its own, those common to all, the readings.
    /// @param surveys      one of_survey() for each survey of the adjustment; those of the group are used.
    /// @param is_extended  they have columns of lags and gravities.
    [[nodiscard]] Normal of_group(const std::vector<Normal>& surveys, std::size_t group,
                                  bool is_extended = false) const;
    /// Returns the products of a group without its own columns, which are integrated out.
    [[nodiscard]] Normal reduced(const Normal& normal, std::size_t group) const;

    /// Returns -ln(likelihood x priors) at a point with the coefficients integrated out, up to a
    /// constant; infinite if it overflows:
    ///
    ///     2 cost = ln det N + ln det(X'N^-1 X + 1) + y'(N + X X')^-1 y + u'u
    ///
    /// y are the readings without their prior expectation, N is the covariance of the noise, X has the
    /// columns in deviations of the priors, u is the point.  For free coefficients alone it is the
    /// restricted likelihood.
    /// @param sum  of the groups' reduced() equations.
    [[nodiscard]] double cost(const DayPoint& point, const Normal& sum) const;

    /// Least-squares coefficients at a point.
    struct Solution {
        Eigen::VectorXd common;                ///< Those of the columns that groups share.
        std::vector<Eigen::VectorXd> surveys;  ///< Those of scaled(), then of the set-ups of a box.
    };
    /// @param scaled  DayRegression::scaled() of each survey at the point.
    [[nodiscard]] Solution solve(const DayPoint& point,
                                 const std::vector<Eigen::MatrixXd>& scaled) const;

private:
    void set_groups();
    void set_hypers();
    void set_columns();
    /// Adds the group of the white surveys.
    void add_white_surveys();
    [[nodiscard]] std::vector<std::size_t> surveys_of_unit(std::size_t unit) const;
    [[nodiscard]] bool has_outer(std::size_t unit) const;
    /// Returns the number of the unit's slopes that act on the scale.
    [[nodiscard]] Eigen::Index on_scale_of(std::size_t unit) const;

    std::vector<DaySurvey> surveys_;
    std::vector<WhiteSurvey> white_surveys_;
    std::vector<double> rough_mgal_;
    std::vector<std::unique_ptr<DayRegression>> regressions_;
    std::vector<Group> groups_;
    std::vector<std::size_t> group_of_, place_in_group_;  ///< One of each survey.
    std::vector<Hyper> hypers_;
    std::vector<Eigen::Index> own_begin_;   ///< First own column of each survey.
    std::vector<Eigen::Index> unit_begin_;  ///< First common column of each unit.
    std::vector<Eigen::Index> places_;
    std::size_t unit_count_ = 0;
    Eigen::Index common_count_ = 0;
};

/// Returns the normal matrix of the first unknowns: products, and the priors of variance 1.
[[nodiscard]] Eigen::MatrixXd with_priors(const Eigen::MatrixXd& products, Eigen::Index count);

}  // namespace a351::corrector::whole_day
