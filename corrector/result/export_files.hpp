#pragma once
/// @file
/// Files of a corrected survey for other programs.  Columns and choices: corrector/methods.md,
/// "Output".

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Returns the stations as GeoJSON (RFC 7946): one feature each, a point with altitude, or without
/// geometry if the position is not known.
[[nodiscard]] std::string stations_geojson(const SurveyCorrection& result,
                                           const std::vector<text::Site>& sites);

/// Returns the occupations as the CSV that GSadjust imports as "csv".
///
/// Tide, temperature and rate are corrected.  Drift is not, because GSadjust estimates it.  Each
/// occupation has two lines, value - u and value + u, because GSadjust takes the standard deviation
/// of a station from the scatter of its lines.  Excluded and flagged occupations are comments.
/// Source: GSadjust of the U.S. Geological Survey, 2022-01-18: gsadjust/file/read.py, read_csv(),
/// for the columns; obstree/station.py, stdev(), and obstree/loop.py, populate(), for their use.
[[nodiscard]] std::string gsadjust_csv(const SurveyCorrection& result,
                                       const std::vector<text::Site>& sites);

}  // namespace a351::corrector
