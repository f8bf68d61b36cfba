#pragma once
/// @file
/// Stations of several surveys: of their adjustment, or if there is none means of the surveys' values.
///
///     const JointTables tables = joint_tables(days, adjustment);
///     const std::string csv = csv_table(joint_columns(), tables.stations);
///
/// The surveys are corrected one by one before, and nothing is fitted here.  Values are those in which
/// the station's own reference had no part, where the model gives them.

#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/model/joint_adjustment.hpp"
#include "corrector/result/column.hpp"

namespace a351::corrector::result {

/// A station over several survey days.  `day_count` is the number of days that have a value of it,
/// `row_count` the number of rows in these values.
///
/// `reference` is that of the last day that has one; `residual` is reference - gravity.
///
/// The uncertainty is sqrt(sum_de w_d w_e C_de) / sum w with w = 1/u^2.  C_dd = u_d^2, and C_de is
/// covariance_mgal2().
struct JointStation {
    std::string site;
    std::size_t day_count = 0;
    std::size_t row_count = 0;
    /// Mean of the days, each weighted by 1/u^2; not weighted if a day has no u, or a u of 0.
    MilliGal gravity;
    std::optional<MilliGal> u_gravity;  ///< Absent if a day has no u.
    std::optional<MilliGal> reference;
    std::optional<MilliGal> residual;
    bool is_in_sample = false;  ///< True: the fit of a day has seen the station's reference.
};

/// The value of a station on one day, as it is joined.
struct DayValue {
    MilliGal gravity;
    std::optional<MilliGal> u;
    bool is_in_sample = false;
};

/// Returns left_out with its uncertainty, or gravity if the model gives no such value; for a station
/// that alone is held by the whole-day model its reference.
[[nodiscard]] DayValue day_value(const model::StationValue& station);

/// Returns the covariance of the errors of two stations of different days, or of one station on two
/// days, mGal^2.
///
/// With the whole-day model it is that of the unit's parameters (lags, slopes, axis biases, scale), if
/// both days took them from priors of one kind, and that of the references that both days hold.  All
/// days are taken as days of one unit.  Drift and noise are of one day.  With other models it is 0.
[[nodiscard]] double covariance_mgal2(const model::StationValue& a, const model::StationValue& b);

/// Returns the stations in the order of their first appearance.
///
/// Every station of a day takes part, also one with flagged rows only.  A day without u makes the
/// mean of its stations a plain one, and their u_gravity absent (joint_table_test.cpp).  Values
/// near 980 000 mGal keep their last digits, because the sum is of differences from the first day.
/// @param days  in any order; no days give no stations.
[[nodiscard]] std::vector<JointStation> join_days(const std::vector<model::SurveyCorrection>& days);

/// Returns the differences of all pairs of join_days(), in its order: gravity of `to` minus that of
/// `from`, with u^2 = u_from^2 + u_to^2 - 2 C.
///
/// C is the covariance of both means.  Two stations of one day have the correlation of
/// Fit::covariance, which the day's drift, response, scale and references make; stations of different
/// days have covariance_mgal2().  A station is in no pair if a day has no u of it, or only flagged
/// rows; or if the covariance of its day is not that of values without the own reference (`network`),
/// or absent (`paper`).
[[nodiscard]] std::vector<model::StationDifference> joint_differences(
    const std::vector<model::SurveyCorrection>& days);

/// Stations and differences of several surveys.
struct JointTables {
    std::vector<JointStation> stations;
    std::vector<model::StationDifference> differences;
};

/// Returns join_days() and joint_differences(); with an adjustment its values and uncertainties.  A
/// station of which all readings are marked is not in the adjustment and keeps its mean.
/// @param adjustment  of the same days; null: there is none.
[[nodiscard]] JointTables joint_tables(const std::vector<model::SurveyCorrection>& days,
                                       const model::JointAdjustment* adjustment);

/// Returns the columns of joint.csv.  The list is made once and lives as long as the program.
[[nodiscard]] const std::vector<Column<JointStation>>& joint_columns();

}  // namespace a351::corrector::result
