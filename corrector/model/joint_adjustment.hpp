#pragma once
/// @file
/// One adjustment of several corrected surveys (whole_day/day_model.hpp).
///
///     const auto joint = adjust_jointly(surveys);
///     if (const auto* const reason = std::get_if<text::Message>(&joint)) return *reason;
///     std::get<JointAdjustment>(joint).stations;
///
/// The surveys are corrected one by one before; that decides about flags, steps and references.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_search.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// A corrected survey, its record and its unit.  Nothing is owned.
struct RecordedSurvey {
    std::string name;
    std::string serial_number;  ///< Empty: not known, so a unit of its own.
    const SurveyCorrection* result = nullptr;
    const reading::DayRecord* day = nullptr;  ///< Null for other models than `day`.
};

/// A station of the adjustment.
struct JointGravity {
    std::string site;
    MilliGal gravity;  ///< With its own reference hidden in all surveys, and all others held.
    MilliGal u;        ///< Standard uncertainty.
    bool is_in_sample = false;  ///< It alone is held: gravity is its reference.
};

/// A unit or a survey of the adjustment, with what belongs to it.
struct JointTerms {
    std::string name;           ///< Name of the survey; empty for a unit.
    std::string model;          ///< Model of the survey; empty for a unit.
    std::string serial_number;  ///< Serial number of the unit.
    std::vector<Coefficient> coefficients;
};

/// The result of adjust_jointly().
struct JointAdjustment {
    std::vector<JointGravity> stations;  ///< In the order of their first accepted reading.
    std::vector<StationDifference>
        differences;                ///< One for each pair, with both references hidden.
    StationCovariance covariance;   ///< Covariance of the gravities in `stations`.
    std::vector<JointTerms> units;  ///< Lags, slopes, axis biases, scale.
    /// Constant, drift, warm-up, steps, noise; of a survey with white noise none.
    std::vector<JointTerms> surveys;
    /// Share of the placement that the sensors of a box have in common; absent without a box.
    std::optional<whole_day::PlacementShare> share;
    /// Factor by which all uncertainties are multiplied: the rms of reference minus gravity divided by
    /// its uncertainty, if that is above 1 and the model does not fit one of the surveys; else 1.
    double uncertainty_factor = 1.0;
};

/// Adjusts the surveys together, or says in words why they cannot be.
///
/// Held are the references that a survey holds, in all surveys.  Surveys with one serial number and one
/// calibration are of one unit.  A survey that another model corrected takes part with white noise and
/// with terms of its own (adjustment/helmert_block.hpp).  It refuses surveys of which
///
/// - one was corrected by `paper`, or its readings at known stations do not determine its noise,
/// - one of another model than `day` has a prior, and another one is of the same unit,
/// - two have different references of one station, or different uncertainties,
/// - two of one unit are at the same time.
/// @param surveys  at least one.  Order: as whole_day::adjust_days().
[[nodiscard]] std::variant<JointAdjustment, text::Message> adjust_jointly(
    const std::vector<RecordedSurvey>& surveys);

}  // namespace a351::corrector::model
