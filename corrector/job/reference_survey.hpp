#pragma once
/// @file
/// A survey of the sensor beside reference gravimeters at the same stations.
///
/// The gravimeters are adjusted as a network, each with constant, drift and scale of its own.  Their
/// values with their uncertainties are then the references of the sensor's survey.
///
///     const NetworkAdjustment reference = hold_reference_values(survey, read);
///     SurveyCorrection result = ...  // of `read`
///     compare_with_reference(result, reference);
///
/// A joint adjustment of all readings gives the same within the weight that the sensor has at a
/// station, 1e-4 for 0.01 mGal beside 1 mGal.  The covariance between the gravimeter's values is
/// neglected: an error that they have in common is one of the level, or of the gravimeter's scale,
/// of which the scale of the sensor therefore has the relative error too.

#include "corrector/job/survey_file.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector::job {

/// Adjusts the gravimeters of a survey and makes their values the references of its rows and sites.
///
/// Held are the references of the sites that the gravimeters measured.  If none of them has one, the
/// mean reading of the sensor at the first common station is held.
/// @param survey  with `reference`.
/// @throws InputError  the table cannot be read or has no gravimeter, no station is common, or the
///                     network refuses.
[[nodiscard]] model::NetworkAdjustment hold_reference_values(const SurveyFile& survey,
                                                             reading::OccupationRows& read);

/// Sets SurveyCorrection::side_by_side, and adds the error of the gravimeter's scale to that of the
/// sensor.
/// @param result     of the rows with these references.
/// @param reference  from hold_reference_values().
void compare_with_reference(model::SurveyCorrection& result,
                            const model::NetworkAdjustment& reference);

}  // namespace a351::corrector::job
