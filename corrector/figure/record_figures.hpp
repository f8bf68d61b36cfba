#pragma once
/// @file
/// Figures of the records of a survey: figures 10 and 11 of the publication.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/representative_value.hpp"

namespace a351::corrector {

/// The record of a row.
struct ReadingRecord {
    std::size_t row = 0;  ///< Index into the survey's rows.
    const RepresentativeValue* value = nullptr;
};

/// Finds the record of each row by its interval, in the order of the rows; rows without one are
/// left out.
[[nodiscard]] std::vector<ReadingRecord> find_records(
    const SurveyCorrection& result, const std::vector<RepresentativeValue>& values);

/// Returns one figure per record: the 2 s series, its trend, the extrema and the limits of the
/// interval.
[[nodiscard]] std::vector<Figure> reading_figures(const SurveyCorrection& result,
                                                  const std::vector<ReadingRecord>& records);

/// Returns two figures of all records side by side at one scale: accelerations and temperatures.
/// They plot the data of reading_figures().
[[nodiscard]] std::vector<Figure> panel_figures(const SurveyCorrection& result,
                                                const std::vector<ReadingRecord>& records);

}  // namespace a351::corrector
