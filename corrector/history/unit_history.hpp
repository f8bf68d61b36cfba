#pragma once
/// @file
/// Terms of a unit by day: what the days of a season say of its constant, slopes, noise and scale.
///
///     std::vector<UnitDay> days = read_unit_days({"monday", "tuesday/result.json"});
///     const std::string csv = csv_table(unit_day_columns(), days);
///     const std::vector<TermSummary> terms = summarise(days);
///
/// Nothing is fitted: the values are those of the days' result.json.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/result/column.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::history {

/// A term of a day's model with its standard uncertainty, in the unit of its name.
struct Term {
    double value = 0.0;
    std::optional<double> u;  ///< std::nullopt: the model gives none.
};

/// A term that a history shows.
struct TermKind {
    std::string_view name;     ///< Name of the coefficient in result.json, with its unit.
    std::string_view u_key;    ///< Key of its uncertainty in history.csv.
    std::string_view heading;  ///< Heading for people, to be translated.
    int decimals;              ///< Decimals for people.
};

/// Returns the terms of the whole-day model that belong to the unit, not to the day's stations.
[[nodiscard]] const std::vector<TermKind>& term_kinds();

/// One day of a unit, corrected with the whole-day model.  Terms of other models have other meanings.
struct UnitDay {
    std::string serial_number;                 ///< Serial number of the sensor.
    UtcTime start;                             ///< First sample of the first reading.
    std::string name;                          ///< Name of the survey.
    std::optional<double> loso_mgal;           ///< Cross-validated error of the day.
    std::vector<std::optional<Term>> terms;    ///< In the order of term_kinds().
    std::optional<double> uncertainty_factor;  ///< 1 if the whole-day model fits; else above 1.
};

/// Reads days, and sorts them by unit and time.
/// @param results  result.json of `survey`, or folders that contain one.
/// @throws InputError  a file cannot be read, is no such file, is of another model or without a
///                     serial number, or two files have the same first reading of a unit.
[[nodiscard]] std::vector<UnitDay> read_unit_days(
    const std::vector<std::filesystem::path>& results);

/// Returns the columns of history.csv.  The list is made once and lives as long as the program.
[[nodiscard]] const std::vector<result::Column<UnitDay>>& unit_day_columns();

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
/// @param days  sorted by unit, as read_unit_days() returns them.
[[nodiscard]] std::vector<TermSummary> summarise(const std::vector<UnitDay>& days);

/// Returns the columns of terms.csv.
[[nodiscard]] const std::vector<result::Column<TermSummary>>& term_summary_columns();

}  // namespace a351::corrector::history
