#pragma once
/// @file
/// Several surveys in one adjustment: the likelihood of their lags and noise, and its linear system.
///
/// It is a part of fit_jointly().  A survey is one unit on one day, and a DayProblem.  Surveys have
/// columns in common, which is all that makes the adjustment joint:
///
/// - of a survey alone: constant, drift, warm-up, steps, states after gaps;
/// - of a unit: the other terms, the lags, and the slopes of an outer oven;
/// - of all: the gravities;
/// - of a box: the part of the placement that all sensors of a set-up have in common.  It is one more
///   unknown for each set-up of the box, with the deviation sqrt(share) placement; the noise of each
///   sensor keeps sqrt(1 - share) placement.
///
/// A *group* is the surveys that have set-ups in common: the sensors of a box on one day; mostly it is
/// one survey.  What only a group has is eliminated in it, so that the cost of a likelihood grows
/// with the number of surveys, and a search that moves one survey computes its group only.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "corrector/whole_day/day_problem.hpp"
#include "corrector/whole_day/joint_model.hpp"

namespace a351::corrector::whole_day {

/// Lags and noise of an adjustment, in deviations from the priors as DayFit::Point.
struct JointPoint {
    /// Fast lag, slow lag, size of the axis biases, lag and size of an outer oven's effect (0 without
    /// one).
    std::vector<std::array<double, 5>> units;
    std::vector<double> placements;              ///< One per group.
    std::vector<std::array<double, 2>> surveys;  ///< Flicker, white.
    double share = 0.0;                          ///< Share of the placement's variance, 0 to 1.
};

/// The surveys of fit_jointly().  Constant members may be called from several threads at a time.
class JointProblem {
public:
    /// Surveys with set-ups in common.
    struct Group {
        std::vector<std::size_t> surveys;
        /// The group's number of each set-up, by survey.
        std::vector<std::vector<std::size_t>> set_ups;
        std::size_t set_up_count = 0;
        Eigen::Index own_count = 0;  ///< Columns that only the group has.
    };
    /// Products of whitened columns, and ln det of what is integrated out of them: noise, own columns.
    struct Normal {
        Eigen::MatrixXd products;
        double log_determinant = 0.0;
    };
    /// Solution of a system at a point.
    struct Solution {
        Eigen::VectorXd common;                ///< Coefficients.
        std::vector<Eigen::VectorXd> surveys;  ///< Coefficients of each survey, as scaled().
    };

    /// @param surveys  kept by reference; as fit_jointly().
    /// @param rough_mgal  gravity from which each unknown counts, by number in the adjustment.
    JointProblem(const std::vector<JointSurvey>& surveys, const std::vector<double>& rough_mgal);

    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
    [[nodiscard]] std::size_t group_of(std::size_t survey) const { return group_of_[survey]; }
    [[nodiscard]] std::size_t unit_count() const { return unit_count_; }
    [[nodiscard]] std::vector<std::size_t> surveys_of_unit(std::size_t unit) const;
    /// Returns true if a survey of the unit has the temperature of an outer oven.
    [[nodiscard]] bool has_outer(std::size_t unit) const;
    /// Returns true if a group has several sensors, so that the share matters.
    [[nodiscard]] bool has_boxes() const;
    [[nodiscard]] const DayProblem& of(std::size_t survey) const { return *problems_[survey]; }
    /// Returns the number of columns that groups have in common.
    [[nodiscard]] Eigen::Index common_count() const { return common_count_; }
    /// Returns the common column of a gravity; -1 if an exact reference is held.
    [[nodiscard]] Eigen::Index place_of(std::size_t number) const { return places_[number]; }
    /// Returns the further common column of a gravity without its reference.
    [[nodiscard]] Eigen::Index own_place_of(std::size_t number) const {
        return common_count_ + static_cast<Eigen::Index>(number);
    }

    /// Returns the point of a survey.
    [[nodiscard]] DayProblem::Point point_of(const JointPoint& point, std::size_t survey) const;
    /// Returns the noise of a survey's readings; of the placement only the sensor's part.
    [[nodiscard]] DayNoise own_noise(const JointPoint& point, std::size_t survey) const;

    /// Returns DayProblem::scaled() of a survey; it does not depend on the noise.
    [[nodiscard]] Eigen::MatrixXd scaled(const JointPoint& point, std::size_t survey) const {
        return of(survey).scaled(point_of(point, survey));
    }
    /// Returns the products of a survey's columns, in the order of places_in_group().
    /// @param scaled  of the survey at the point.
    /// @param values  null: neither lags nor gravities without reference have columns.  Else the
    ///                estimates of the survey, for the columns of its lags.
    [[nodiscard]] Normal of_survey(const JointPoint& point, std::size_t survey,
                                   const Eigen::MatrixXd& scaled,
                                   const Eigen::VectorXd* values = nullptr) const;
    /// Returns the products of a group's columns: its own, those common to all, the readings.
    /// @param surveys      one of_survey() for each survey of the adjustment; those of the group are used.
    /// @param is_extended  they have columns of lags and gravities.
    [[nodiscard]] Normal of_group(const std::vector<Normal>& surveys, std::size_t group,
                                  bool is_extended = false) const;
    /// Returns the products of a group without its own columns, which are integrated out.
    [[nodiscard]] Normal reduced(const Normal& normal, std::size_t group) const;

    /// Returns -ln(restricted likelihood x priors) at a point; infinite if it overflows.
    /// @param sum  of the groups' reduced() equations.
    [[nodiscard]] double cost(const JointPoint& point, const Normal& sum) const;

    /// Returns the least-squares coefficients at a point.
    [[nodiscard]] Solution solve(const JointPoint& point) const;

    /// Returns the place of each column of a survey in its group's products: the readings, the columns
    /// of DayProblem::scaled(), the set-ups, the lags, the gravities without reference.
    [[nodiscard]] std::vector<Eigen::Index> places_in_group(std::size_t survey,
                                                            bool is_extended) const;

private:
    void set_groups();
    void set_columns();

    const std::vector<JointSurvey>& surveys_;
    std::vector<std::unique_ptr<DayProblem>> problems_;
    std::vector<Group> groups_;
    std::vector<std::size_t> group_of_, place_in_group_;  ///< One of each survey.
    std::vector<Eigen::Index> own_begin_;                 ///< First own column of each survey.
    std::vector<Eigen::Index> unit_begin_;                ///< First common column of each unit.
    std::vector<Eigen::Index> places_;
    std::size_t unit_count_ = 0;
    Eigen::Index common_count_ = 0;
};

}  // namespace a351::corrector::whole_day
