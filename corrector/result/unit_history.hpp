#pragma once
/// @file
/// Terms of a unit by day over a season: constant, slopes, noise and scale.
///
///     const std::vector<UnitDay> days = unit_days(surveys);
///     const std::string csv = csv_table(unit_day_columns(), days);
///     const std::vector<TermSummary> terms = summarise(days);
///
/// Nothing is fitted: the values are those of each survey alone, not of their adjustment.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/joint_adjustment.hpp"
#include "corrector/result/column.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::result {

/// A term that a history shows.
struct TermKind {
    std::string_view name;     ///< Name of the coefficient, with its unit.
    std::string_view u_key;    ///< Key of its uncertainty in history.csv.
    std::string_view heading;  ///< Heading for people, to be translated.
    int decimals;              ///< Decimals for people.
};

/// Returns the terms of the whole-day model that belong to the unit, not to the day's stations.
[[nodiscard]] const std::vector<TermKind>& term_kinds();

/// One day of a unit.
struct UnitDay {
    std::string serial_number;        ///< Serial number of the sensor.
    UtcTime start;                    ///< First sample of the first reading.
    std::string name;                 ///< Name of the survey.
    std::optional<double> loso_mgal;  ///< Cross-validated error of the day.
    double uncertainty_factor = 1.0;  ///< 1 if the model fits; else above 1.
    /// In the order of term_kinds(); absent if the day's model has no such term.
    std::vector<std::optional<model::Coefficient>> terms;
};

/// Returns the surveys that the whole-day model corrected and whose serial number is known, sorted by
/// unit and time.  Terms of other models have other meanings.
[[nodiscard]] std::vector<UnitDay> unit_days(const std::vector<model::RecordedSurvey>& surveys);

/// Returns the columns of history.csv.  The list is made once and lives as long as the program.
[[nodiscard]] const std::vector<Column<UnitDay>>& unit_day_columns();

/// A term of a unit over its days.
///
/// A term that does not change has a scatter of about its rms u, or below: the priors, which all
/// days share, are in u but do not scatter.
struct TermSummary {
    std::string serial_number, term;
    std::size_t day_count = 0;
    double mean = 0.0;              ///< Plain mean of the days.
    std::optional<double> scatter;  ///< Standard deviation of a day; std::nullopt for one day.
    std::optional<double> rms_u;    ///< Root of the mean square of the days' u.
};

/// Returns a row for each unit and term that a day of it has.
/// @param days  sorted by unit, as unit_days() returns them.
[[nodiscard]] std::vector<TermSummary> summarise(const std::vector<UnitDay>& days);

/// Returns the columns of terms.csv.
[[nodiscard]] const std::vector<Column<TermSummary>>& term_summary_columns();

}  // namespace a351::corrector::result
