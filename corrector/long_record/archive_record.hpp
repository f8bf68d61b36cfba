#pragma once
/// @file
/// A long record from the archive of a data root.

#include <filesystem>
#include <optional>

#include "corrector/long_record/long_record.hpp"
#include "corrector/reading/on_all_cores.hpp"

namespace a351::corrector {

/// The part of a record that is read.
struct RecordWindow {
    std::optional<UtcTime> from;  ///< Start; absent: from the first sample.
    std::optional<UtcTime> to;    ///< End, not included; absent: to the last sample.
};

/// Reads a record day by day, decimates it, and subtracts the direct tide at the station's
/// position.  Memory is that of one day of samples, whatever the length.  Without a position the
/// tide is not removed, with a warning.
///
/// Samples are counted, not timed: a gap of half a sample or more between neighbouring records
/// becomes the same number of missing samples.  A new stretch begins after a gap of more than an
/// hour, where the time goes back, and where the sensor, a scale or the rate changes.
/// @param root      data root with archive/ and metadata/station.xml.
/// @param window    part to be read.
/// @param progress  called with the days done and in all.
/// @throws InputError  if the metadata cannot be read, if the archive has no sample of the vertical
///                     axis in the window, if whole stages of 10 do not lead from its rate to 20 s
///                     within 10 %, or if a part would have another step than the rest.
[[nodiscard]] LongRecord read_archive_record(const std::filesystem::path& root,
                                             const RecordWindow& window, const Progress& progress);

}  // namespace a351::corrector
