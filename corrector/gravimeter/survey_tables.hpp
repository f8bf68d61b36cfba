#pragma once
/// @file
/// The tables that `a351-correct table` reads, from the stays of gravimeters.
///
///     text::write_together("out", survey_tables(files, stays, options));

#include <optional>
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
    /// The permanent tide that gravity keeps, and the column tide_system.  Absent: no column, and
    /// gravity keeps what the instruments leave, which is tide_free.
    std::optional<tide::System> tide_system = {};
};

/// Returns observations.csv, sites.csv and readings.csv (gravimeter-format.md).
///
/// acceleration_mgal is the average plus the effect of the tide that the instrument removed.  Thus
/// acceleration_mgal - earth_tide_mgal is the instrument's own value, and no tide is removed twice.
/// In a tide system it is this value plus what the system keeps, at the first position of the site.
/// @throws InputError  keeps_tide, and the instrument removed no tide in some of the stays; or a
///                     tide system, and a site without a position.
[[nodiscard]] std::vector<text::NamedText> survey_tables(const std::vector<GravimeterFile>& files,
                                                         const std::vector<Stay>& stays,
                                                         const TableOptions& options);

}  // namespace a351::corrector::gravimeter
