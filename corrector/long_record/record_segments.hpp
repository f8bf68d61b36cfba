#pragma once
/// @file
/// The segments of a long record that can be analysed, and the reasons why other parts cannot.
///
///     const RecordSegments parts = divide_record(record);
///     for (const RefusedPart& part : parts.refused) show(part.start, part.reason);
///     for (const RecordSegment& segment : parts.segments) analyse(segment);
///
/// Spectra and decompositions need series without gaps.  They also need one state of the unit:
/// after a step the box has moved, and after a restart the unit warms up again.

#include <string>
#include <vector>

#include "corrector/long_record/long_record.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

/// Longest gap that is bridged by a straight line, samples.  Reason: a third of a cycle of 15 min.
inline constexpr std::size_t kLongestBridge = 15;

/// Limits for the division into segments; samples are 20 s apart.
struct SegmentOptions {
    /// Shortest segment, samples.  Reason: 3 h are twelve cycles of 15 min.
    std::size_t shortest = 540;
};

/// A run of n samples without a break; missing samples are bridged by straight lines.
///
/// Both series are finite and have the length n.  Sample i is at start + i x LongRecord::step_s,
/// within half a step.  The first and the last sample are measured ones.
struct RecordSegment {
    UtcTime start;                 ///< Time of the first sample.
    UtcTime end;                   ///< Time of the last sample.
    std::string serial_number;     ///< Serial number of the sensor; empty: not known.
    text::Message begins_with;     ///< Reason of its start: "the record begins", "gap of 512 s" ...
    std::vector<double> quantity;  ///< (n) As RecordStretch::quantity.
    std::vector<double> temperature_degc;  ///< (n)
    std::vector<double> outer_degc;        ///< (n), or empty without an outer oven.
    std::size_t bridged = 0;               ///< Number of samples from straight lines.
    std::size_t disturbed = 0;             ///< Number of these that replace knocks.
    bool is_restart = false;               ///< True: the sensor was switched on before it.

    /// Returns n.
    [[nodiscard]] std::size_t size() const noexcept { return quantity.size(); }
    /// Returns its length, h, at LongRecord::step_s.
    [[nodiscard]] double hours(double step_s) const {
        return static_cast<double>(size()) * step_s / kSecondsPerHour;
    }
};

/// A part that is not analysed, from its first to its last sample.  Parts may overlap if several
/// channels are stuck at once.  `reason` is a text for people, with the value or length found.
struct RefusedPart {
    UtcTime start, end;
    text::Message reason;
};

/// The parts of a record.  Missing samples between them are in neither list.
struct RecordSegments {
    std::vector<RecordSegment> segments;  ///< In order of time.
    std::vector<RefusedPart> refused;     ///< In order of their start.
};

/// Divides a record at gaps, at steps of the acceleration and at restarts.  Stuck samples, and values
/// that no sensor sends (sensor_limits.hpp), are refused and count as missing.  Rules:
/// corrector/long_record/long_record.md, "Segments".
///
/// - Gaps of up to kLongestBridge samples, and knocks, are bridged.
/// - `begins_with` has the break before a segment.  A change of sensor, scale or rate has priority
///   over the gap.
/// - A power cycle that leaves no longer gap and no change of temperature is not found.
///
/// A record without valid samples has no segments (record_segments_test.cpp).  Deterministic; the
/// record is not changed, and its samples are copied.
/// @param record   stretches in order of time.
/// @param options  see SegmentOptions; the length of a segment includes bridged samples.
[[nodiscard]] RecordSegments divide_record(const LongRecord& record,
                                           const SegmentOptions& options = {});

}  // namespace a351::corrector::long_record
