#pragma once
/// @file
/// Common parts of the figures of the records and of the day.

#include <string>
#include <vector>

#include "corrector/figure/survey_figures.hpp"

namespace a351::corrector::figure {

/// Returns the name of a reading's figure, in whose data are its samples.
[[nodiscard]] std::string reading_figure_name(std::size_t row);

/// Returns half the range of an axis for the samples of all records, each about the value of its
/// reading: mGal, or degC of the temperatures.  Nine of ten samples of every record are within, with
/// room, so that a knock does not flatten the rest.
[[nodiscard]] double half_range_of(const model::SurveyCorrection& result,
                                   const std::vector<ReadingRecord>& records, bool is_temperature);

}  // namespace a351::corrector::figure
