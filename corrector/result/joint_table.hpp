#pragma once
/// @file
/// Stations of several surveys: of their adjustment, with the surveys' own values beside it.
///
///     const JointTables tables = joint_tables(surveys, adjustment);
///     const std::string csv = csv_table(joint_columns(), tables.stations);
///
/// The surveys are corrected one by one before, and nothing is fitted here.  Without an adjustment no
/// value is common to the surveys; table_by_survey() shows their own values side by side.

#include <string>
#include <vector>

#include "corrector/model/joint_adjustment.hpp"
#include "corrector/result/column.hpp"

namespace a351::corrector::result {

/// A station over several surveys.
struct JointStation {
    std::string site;
    std::size_t day_count = 0;  ///< Number of surveys that have a value of it.
    std::size_t row_count = 0;  ///< Number of rows in these values.
    /// Gravity of the adjustment and its standard uncertainty; absent without an adjustment, or if
    /// all readings are marked.
    std::optional<MilliGal> gravity, u_gravity;
    std::optional<MilliGal> reference;  ///< Reference in the last survey that has one.
    std::optional<MilliGal> residual;   ///< gravity - reference.
    /// True: gravity has seen the station's reference; without an adjustment a survey's value.
    bool is_in_sample = false;
};

/// Stations in the order of their first appearance, and differences of the adjustment.
struct JointTables {
    std::vector<JointStation> stations;
    std::vector<model::StationDifference> differences;  ///< None without an adjustment.
};

/// Returns the stations of the surveys with the values of their adjustment.
/// @param adjustment  of the same surveys; null: there is none.
[[nodiscard]] JointTables joint_tables(const std::vector<model::RecordedSurvey>& surveys,
                                       const model::JointAdjustment* adjustment);

/// Returns the columns of joint.csv.  The list is made once and lives as long as the program.
[[nodiscard]] const std::vector<Column<JointStation>>& joint_columns();

/// Returns joint_columns() for people, with a column for each survey: its own value minus the joint
/// one, or without an adjustment the value itself with its standard uncertainty.  A star marks a
/// value of marked readings only.
[[nodiscard]] Table table_by_survey(const std::vector<JointStation>& stations,
                                    const std::vector<model::RecordedSurvey>& surveys,
                                    bool is_adjusted);

/// The value of a station in one survey, as it is compared with those of other surveys.
struct DayValue {
    MilliGal gravity;
    std::optional<MilliGal> u;
    bool is_in_sample = false;
};

/// Returns left_out with its uncertainty, or gravity if the model gives no such value; for a station
/// that alone is held by the whole-day model its reference.
[[nodiscard]] DayValue day_value(const model::StationValue& station);

/// Returns the covariance of the errors of one station on two days, mGal^2.
///
/// With the whole-day model it has two parts.  The first comes from the unit's parameters (lags,
/// slopes, axis biases, scale), if both days took them from priors of one kind.  The second comes
/// from the references that both days hold.  All days are taken as days of one unit.  Drift and
/// noise belong to one day.  With other models the covariance is 0.
[[nodiscard]] double covariance_mgal2(const model::StationValue& a, const model::StationValue& b);

}  // namespace a351::corrector::result
