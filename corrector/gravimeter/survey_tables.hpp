#pragma once
/// @file
/// The tables that `a351-correct table` reads, from the stays of gravimeters.
///
///     text::write_together("out", survey_tables(files, stays, options));

#include <vector>

#include "corrector/gravimeter/stays.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::gravimeter {

/// Options of the tables.
struct TableOptions {
    AverageOptions average;
    /// True: earth_tide_mgal has the tide that the instrument removed.  False: the column is absent,
    /// so that `table` computes the tide.
    bool keeps_tide = true;
};

/// Returns observations.csv, sites.csv and readings.csv (gravimeter-format.md).
///
/// acceleration_mgal is the average plus the effect of the tide that the instrument removed.  Thus
/// acceleration_mgal - earth_tide_mgal is the instrument's own value, and no tide is removed twice.
/// @throws InputError  keeps_tide, and the instrument removed no tide in some of the stays.
[[nodiscard]] std::vector<text::NamedText> survey_tables(const std::vector<GravimeterFile>& files,
                                                         const std::vector<Stay>& stays,
                                                         const TableOptions& options);

}  // namespace a351::corrector::gravimeter
