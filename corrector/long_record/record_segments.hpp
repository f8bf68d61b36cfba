#pragma once
/// @file
/// The parts of a long record that can be analysed, and why the rest cannot.

#include <string>
#include <vector>

#include "corrector/long_record/long_record.hpp"

namespace a351::corrector {

struct SegmentOptions {
    /// Longest gap bridged by a straight line, in samples: a third of a cycle of 15 min.
    std::size_t longest_bridge = 15;
    /// Shortest segment in samples: 3 h, twelve cycles of 15 min.
    std::size_t shortest = 540;
    /// A temperature, axis or acceleration that is the same to the last digit for so many samples, 20 min, is
    /// stuck: the sensor has more noise than that.
    std::size_t stuck = 60;
    /// A step between the medians of nine samples before and after, over 1.4826 MAD of all such
    /// differences, and at least in mGal: the box was moved.
    double step_threshold = 8.0;
    double least_step_mgal = 5.0;
    /// find_disturbances(): knocks.
    double disturbance_threshold = 8.0;
    /// Change of temperature across a gap after which the sensor must have been without power: five
    /// times the cycle's swing.
    double restart_degc = 0.1;
};

/// A run of samples without a break, bridged where single ones were missing.
struct RecordSegment {
    UtcTime start;
    UtcTime end;                ///< Of the last sample.
    std::string serial_number;  ///< Of the sensor; empty: not told.
    std::string begins_with;    ///< Why it begins: "the record begins", "gap of 512 s" ...
    std::vector<double> acceleration_mgal;
    std::vector<double> temperature_degc;
    std::size_t bridged = 0;    ///< Samples made by a straight line ...
    std::size_t disturbed = 0;  ///< ... of which so many were knocks.
    bool is_restart = false;    ///< The sensor was switched on before it.

    [[nodiscard]] std::size_t size() const noexcept { return acceleration_mgal.size(); }
};

/// A part that is not analysed.
struct RefusedPart {
    UtcTime start, end;
    std::string reason;
};

struct RecordSegments {
    std::vector<RecordSegment> segments;  ///< In order of time.
    std::vector<RefusedPart> refused;
};

/// Divides a record at gaps, steps of the acceleration, restarts and where a channel is stuck.  Samples
/// that are stuck are missing ones.
[[nodiscard]] RecordSegments divide_record(const LongRecord& record,
                                           const SegmentOptions& options = {});

}  // namespace a351::corrector
