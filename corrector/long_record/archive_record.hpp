#pragma once
/// @file
/// A long record from the archive of a data root.
///
///     const LongRecord record = read_archive_record("data", {}, progress);
///     const RecordSegments parts = divide_record(record);
///
/// The daemon may write to the data root meanwhile; nothing there is changed.

#include <filesystem>
#include <optional>

#include "corrector/archive_series/on_all_cores.hpp"
#include "corrector/long_record/long_record.hpp"
#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector::long_record {

/// The part of a record that is read.  A default-constructed one is the whole record.
///
/// The limits concern raw samples.  Decimated from 50 Hz, samples within 91 s of each end are
/// missing, because their filters are not filled.  `from` after `to` gives no sample; the functions
/// that read report this as an error.
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
///
/// - Warnings name damage of the archive, every change of sensor, scale or rate, and times that go
///   back.
/// - The vertical axis decides which samples exist.  Samples of another channel are missing where
///   its rate is another one.
/// - Each part is scaled by the epoch of station.xml that it belongs to (archive_record_test.cpp).
/// - `inputs` has station.xml and every day file of the four channels in the window.
///
/// The result does not depend on the number of cores, which read the four channels at once.
/// @param root      data root with archive/ and metadata/station.xml.
/// @param window    part to be read.
/// @param progress  called with the days done and in all, in the caller's thread.
/// @param system    of the gravity that remains after the tide is subtracted.
/// @throws InputError  if the metadata cannot be read, if the archive has no sample of the vertical
///                     axis in the window, if whole stages of 10 do not lead from its rate to 20 s
///                     within 10 %, or if a part would have another step than the rest.
[[nodiscard]] LongRecord read_archive_record(const std::filesystem::path& root,
                                             const RecordWindow& window,
                                             const archive_series::Progress& progress,
                                             tide::System system = tide::System::tide_free);

}  // namespace a351::corrector::long_record
