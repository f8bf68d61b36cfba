#pragma once
/// @file
/// A survey of the sensor beside reference gravimeters at the same stations.
///
/// The gravimeters are adjusted as a network, each with constant, drift and scale of its own.  Their
/// values with their uncertainties are then the references of the sensor's survey.
///
///     const ReferenceNetwork reference = hold_reference_values(survey, read);
///     SurveyCorrection result = ...  // of `read`
///     compare_with_reference(result, reference);
///
/// Limits:
/// - The sensor's readings do not improve the gravimeters' values, as they would in a joint
///   adjustment.  Their weight there is small: 1e-4 for 1 mGal beside 0.01 mGal.
/// - Covariances between the gravimeters' values are neglected.  Errors that the values have in
///   common are those of the level and of the gravimeters' scale.  compare_with_reference() adds
///   the latter.

#include <map>
#include <string>

#include "corrector/job/survey_file.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector::job {

/// Value of a station in the gravimeters' network.
struct ReferenceValue {
    MilliGal gravity, u;
};

/// The gravimeters' network.
struct ReferenceNetwork {
    std::map<std::string, ReferenceValue> values;  ///< One per station.
    model::SideBySide network;  ///< Without what the sensor's survey gives: bias and stations.
};

/// Adjusts the gravimeters of a survey and makes their values the references of its rows and sites.
///
/// Held are the references of the sites that the gravimeters measured.  If none of them has one,
/// the mean reading of the sensor at the first common station is held, and the values show
/// differences only (reference_survey_test.cpp).
/// @param survey  with `reference`.
/// @throws InputError  the table cannot be read or has no gravimeter, or the network refuses.  No
///                     common station is an error only if none of the sites has a reference.
[[nodiscard]] ReferenceNetwork hold_reference_values(const SurveyFile& survey,
                                                     reading::OccupationRows& read);

/// Sets SurveyCorrection::side_by_side, and adds the relative error of the gravimeter's scale to
/// that of the sensor's scale, as an independent error.  With several gravimeters the smallest of
/// their errors counts.
/// @param result     of the rows with these references.
/// @param reference  from hold_reference_values().
void compare_with_reference(model::SurveyCorrection& result, const ReferenceNetwork& reference);

}  // namespace a351::corrector::job
