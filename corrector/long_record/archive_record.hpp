#pragma once
/// @file
/// A long record from the archive of a data root.

#include <filesystem>
#include <optional>

#include "corrector/long_record/long_record.hpp"
#include "corrector/reading/on_all_cores.hpp"

namespace a351::corrector {

/// What of a record is read.
struct RecordWindow {
    std::optional<UtcTime> from;  ///< Absent: from the first sample.
    std::optional<UtcTime> to;    ///< Absent: to the last one.
};

/// Reads day by day, decimates and removes the direct earth tide of the station's position: memory
/// for one day of samples however long the record.
///
/// Samples are counted, not timed: a gap (half a sample or more between neighbouring records) becomes
/// as many missing samples; after a gap of more than an hour, where the time goes back, and where the
/// sensor, a scale or the rate changes, a new stretch begins.
/// @param root      holds archive/ and metadata/station.xml.
/// @param progress  counts days.
/// @throws InputError  the metadata cannot be read, the archive has no sample of the vertical axis in
///                     the window, or one every so often that no whole stages of 10 lead to 20 s, or in
///                     one part to another step than in the rest.
[[nodiscard]] LongRecord read_archive_record(const std::filesystem::path& root,
                                             const RecordWindow& window, const Progress& progress);

}  // namespace a351::corrector
