#pragma once
/// @file
/// Which sensor recorded when, by the serial numbers in the station metadata.
///
///     const std::vector<UnitSpan> spans = read_unit_spans(root / "metadata/station.xml");
///     const UnitSpan& span = span_at(spans, window.start);
///     keep_unit(samples, spans, span.serial_number);

#include <filesystem>
#include <string>
#include <vector>

#include "corrector/archive_series/epoch.hpp"
#include "protocol/archive/archive_reader.hpp"

namespace a351::corrector::archive_series {

/// A time in which one sensor recorded: [from, to).
struct UnitSpan {
    UtcTime from, to;           ///< UtcTime::min() of the first span, UtcTime::max() of the last.
    std::string serial_number;  ///< Empty: not known, in no span of the file.
};

/// Reads the spans in order of time, at least one; neighbours have different serial numbers.  A time
/// without a serial number belongs to the sensor before it.
/// @throws InputError  as station::read_station_epochs().
[[nodiscard]] std::vector<UnitSpan> read_unit_spans(const std::filesystem::path& metadata);

/// Returns the span of an instant.  A span also has the instants in the second before its begin,
/// because the begin is a reading of the host's clock and not the time of a sample.
/// @param spans  from read_unit_spans().
[[nodiscard]] const UnitSpan& span_at(const std::vector<UnitSpan>& spans, UtcTime time);

/// Removes the samples of other sensors from the channels that the sensor itself has.  A segment is
/// of one sensor, which the middle of the segment tells: times that were corrected later may differ
/// from those of the metadata.
/// @param samples  in the order of Epoch::channels.
void keep_unit(std::vector<archive::ChannelData>& samples, const std::vector<UnitSpan>& spans,
               const std::string& serial_number);

}  // namespace a351::corrector::archive_series
