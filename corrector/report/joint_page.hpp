#pragma once
/// @file
/// joint.html: several surveys side by side.
///
/// The page shows whether the days agree: by the difference of each day from the joint value, or
/// without an adjustment by their values, and by the scatter of the days against the uncertainties.
/// Use it for two days or more.

#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/report/report.hpp"
#include "corrector/result/joint_report.hpp"
#include "corrector/result/unit_history.hpp"

namespace a351::corrector::report {

/// One day of the survey: its result, or the reason why there is none.
///
/// The result is not owned and must live during the call of make_joint_page().  It has at least one
/// row.  `name` may be any text.  `folder` is a plain name; the page encodes it in the address.
struct JointDay {
    std::string name;                                 ///< Name of the day, as in its survey file.
    std::string folder;                               ///< Folder of its result, next to the page.
    const model::SurveyCorrection* result = nullptr;  ///< Result; null if not corrected.
    std::string trouble = {};                         ///< Reason if not corrected.
};

/// Scatter from day to day of stations measured on several days.
///
/// If `rms_mgal` is well above `expected_mgal`, the days differ by more than their uncertainties
/// explain.
struct DayScatter {
    double rms_mgal = 0.0;  ///< RMS about the mean of each station, divisor `dof`.
    std::size_t dof = 0;    ///< Degrees of freedom: the sum over stations of days minus one.
    /// The same from the covariance of the days' values, E = sum over stations of
    /// [sum_d u_d^2 (1 - 1/n) - sum_{d != e} C_de / n] / dof; absent if a value has no u.
    std::optional<double> expected_mgal;
};

/// Computes the scatter from day to day:
///
///     rms^2 = sum over stations and days of (value - mean of the station's days)^2 / dof
///
/// The means are not weighted.  Stations of one day have no influence.  A day of a station counts
/// even if all its rows are flagged.
/// @return std::nullopt if no station was measured on two days.
[[nodiscard]] std::optional<DayScatter> scatter_of_days(
    const std::vector<model::RecordedSurvey>& days);

/// Makes joint.html: what to do about each station, the joint stations with the difference of each
/// day, the terms of the units by day, and the days with their scores and links to their reports.
///
/// A station has the best grade of its days.  It gets `care` or `repeat` if two days disagree by more
/// than 2 or 3 times the uncertainty of their difference.
///
/// Days without a result are listed first, with their reasons.  The links lead to
/// FOLDER/report.html.  All texts are escaped, and the page is well-formed XML
/// (joint_page_test.cpp).
/// @param days   in the order of the page.
/// @param joint  adjustment of the days with a result, or why there is none.
/// @param units  days of the units; without them the page has no section about units.
[[nodiscard]] Report make_joint_page(const std::vector<JointDay>& days,
                                     const result::JointResult& joint,
                                     const std::vector<result::UnitDay>& units,
                                     const figure::FigureOptions& options);

}  // namespace a351::corrector::report
