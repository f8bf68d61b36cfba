#pragma once
/// @file
/// A corrected survey for other programs.  Columns and choices: corrector/methods.md, "Output".

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// The stations as GeoJSON (RFC 7946): one feature each, a point with altitude; without a geometry
/// where the position is not known.
[[nodiscard]] std::string stations_geojson(const SurveyCorrection& result,
                                           const std::vector<text::Site>& sites);

/// The occupations as the CSV that GSadjust imports as "csv": tide, temperature and rate corrected,
/// drift not, for that is what GSadjust estimates.  Each is two lines, value - u and value + u, for
/// it takes a station's standard deviation from the scatter of its lines.  Excluded and flagged ones are
/// comments.
/// Source: GSadjust of the U.S. Geological Survey, 2022-01-18: gsadjust/file/read.py, read_csv(), for
/// the columns; obstree/station.py, stdev(), and obstree/loop.py, populate(), for what becomes of them.
[[nodiscard]] std::string gsadjust_csv(const SurveyCorrection& result,
                                       const std::vector<text::Site>& sites);

/// Both, named stations.geojson and gsadjust.csv.
/// @param sites  every station's is among them.
[[nodiscard]] std::vector<text::NamedText> export_files(const SurveyCorrection& result,
                                                        const std::vector<text::Site>& sites);

}  // namespace a351::corrector
