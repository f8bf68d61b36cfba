#pragma once
/// @file
/// A record of hours to weeks at one point, at the rate at which it is analysed.
///
/// The way of a record through this folder:
///
///     LongRecord record = joined_record(read_records(files, window));
///     RecordSegments parts = divide_record(record);
///     RecordAnalysis analysis = analyse_record(parts.segments[k], record.step_s, options);
///
/// A record has stretches: samples on one clock, with missing ones among them.  A segment is a part
/// of a stretch without a break, in which missing samples are bridged.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

/// Time between samples, s.  Source: the publication's record, decimated from 50 Hz.
inline constexpr double kRecordStep_s = 20.0;
/// Factor of a decimation stage, dimensionless.
inline constexpr int kRecordFactor = 10;
/// Number of stages from 50 Hz to kRecordStep_s.
inline constexpr int kMostRecordStages = 3;

/// Longest gap within a stretch, s; a longer one begins a new stretch.  Within a stretch, gaps of
/// more than kLongestBridge samples still divide segments (record_segments.hpp).
inline constexpr double kLongestGap_s = 3600.0;
/// Value of a missing sample.  Find one with std::isnan(): NaN is not equal to itself.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Samples on one clock; missing samples are NaN.  All vectors have the same length n; `raw`,
/// `axes_mgal` and `outer_degc` may be empty.
///
/// Invariants of a stretch that was read: n >= 1, times ascend, and neighbours are about one step
/// apart.  A sample may be missing in one series and exist in another.  A default-constructed
/// stretch is empty.
struct RecordStretch {
    /// Smallest and largest raw value from the time of a decimated sample to just before the next
    /// one; NaN if all raw values are missing.
    struct RawRange {
        double acceleration_low_mgal, acceleration_high_mgal;
        double temperature_low_degc, temperature_high_degc;
    };

    std::string serial_number;  ///< Serial number of the sensor; empty: not known.
    /// Change at the start of the stretch, e.g. "another sensor: ..."; empty: start or gap.
    text::Message begins_with;
    std::vector<UtcTime> times;  ///< (n) Times of the samples.
    /// (n) Norm of the decimated axes, in LongRecord::unit; the tilt in its place after tilt_record().
    std::vector<double> quantity;
    /// Axes x, y, z (n each) as the sensor gave them, with the tide; empty if only the norm is
    /// known.
    std::vector<std::vector<double>> axes_mgal;
    std::vector<double> temperature_degc;  ///< (n)
    /// Temperature of an outer oven (n), NaN in gaps of more than 10 min; empty if there is none.
    std::vector<double> outer_degc;
    std::vector<RawRange> raw;  ///< (n); empty if nothing was decimated.

    /// Returns n.
    [[nodiscard]] std::size_t size() const noexcept { return times.size(); }
};

/// A record, as read.
///
/// `raw_rate_hz` and `step_s` belong to the first stretch.  Further stretches have the same step
/// within 0.1 %.
struct LongRecord {
    std::filesystem::path source;          ///< File or data root; empty for a joined record.
    std::vector<RecordStretch> stretches;  ///< In order of time; each has at least one sample.
    double raw_rate_hz = 0.0;              ///< Rate before decimation.
    double step_s = kRecordStep_s;         ///< Time between samples, on the sensor's clock.
    std::string unit = "mGal";             ///< "urad" after tilt_record().
    bool is_tide_removed = false;          ///< True: the direct tide was subtracted.
    /// Noise of an axis by the data sheet of the sensor of the first part, mGal / sqrt(Hz); absent if it
    /// is not known.
    std::optional<double> data_sheet_mgal_per_sqrt_hz;
    std::vector<text::InputFile> inputs;  ///< Files that were read.
    std::vector<text::Message> warnings;  ///< Skipped data, divisions and other facts, with reason.
};

}  // namespace a351::corrector::long_record
