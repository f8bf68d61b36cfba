#pragma once
/// @file
/// Files of a corrected survey for other programs.  Columns and choices: corrector/methods.md,
/// "Output".
///
/// Use these files for maps and for an adjustment with other data.  They have fewer digits than
/// result.json.  The functions return the content and write no file.
///
/// All take the positions from a table of sites.  A station that is absent there is left out
/// without a message.  The same result and sites give the same bytes.

#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::result {

/// Returns the stations as GeoJSON (RFC 7946): one feature each, a point with altitude, or without
/// geometry if the position is not known.
///
/// Coordinates are longitude and latitude in degrees, rounded to 1e-9, and altitude in m.  The
/// longitude is -180 to 180 also if the table has 0 to 360 (export_files_test.cpp).
///
/// Properties are site, n, gravity_mgal, u_gravity_mgal, reference_mgal, residual_mgal,
/// flagged_only, grade and grade_reason (grade_of_station()).  Values are rounded to 1e-6 mGal;
/// null if there is none.  The text is UTF-8 with one line per feature.  Bytes of a name that are
/// not UTF-8 become U+FFFD.
/// @param sites  position of each station; Site::is_placed false: without geometry.
[[nodiscard]] std::string stations_geojson(const model::SurveyCorrection& result,
                                           const std::vector<text::Site>& sites);

/// Returns the occupations as the CSV that GSadjust imports as "csv".
///
/// Tide, height, air pressure, tilt, temperature and rate are corrected.  Drift is not, because
/// GSadjust estimates it, nor is the flicker of the whole-day model (export_files_test.cpp).  Each
/// occupation has two lines, value - u and value + u, because GSadjust takes the standard deviation
/// of a station from the scatter of its lines.  Excluded occupations are comments, and so are
/// flagged ones with SurveyOptions::use_flags.
///
/// - u is CorrectedRow::u_corrected, or 2 mGal if the fit has none.
/// - The tide column is the correction that was added, -tide, so that GSadjust can replace it.
/// - Times are UTC, truncated to seconds, and the date is MM/DD/YYYY.
/// - The duration is that of the averaging interval, s; 0 if it is not known.
/// - '/', ':' and '%' in names become '-', because GSadjust's reader splits lines there.
///
/// Occupations without a row (left_out) are not in the file.
/// @param sites  position of each station, also an estimated one (Site::is_placed false).
/// Source: GSadjust of the U.S. Geological Survey, 2022-01-18: gsadjust/file/read.py, read_csv(),
/// for the columns; obstree/station.py, stdev(), and obstree/loop.py, populate(), for their use.
[[nodiscard]] std::string gsadjust_csv(const model::SurveyCorrection& result,
                                       const std::vector<text::Site>& sites);

/// Returns the files of a survey for other programs.
[[nodiscard]] std::vector<text::NamedText> export_files(const model::SurveyCorrection& result,
                                                        const std::vector<text::Site>& sites);

}  // namespace a351::corrector::result
