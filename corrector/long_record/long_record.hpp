#pragma once
/// @file
/// A record of hours to weeks at one point, at the rate on which it is analysed.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {

/// The publication's samples: three stages of 10 from 50 Hz.
inline constexpr double kRecordStep_s = 20.0;
inline constexpr int kRecordFactor = 10;
inline constexpr int kMostRecordStages = 3;

/// A longer gap begins a new stretch.
inline constexpr double kLongestGap_s = 3600.0;
/// A sample that is not there.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Samples on one clock; missing ones are NaN.  All vectors have the same length, but `raw` is empty
/// where nothing was decimated.
struct RecordStretch {
    /// Least and greatest sample before decimation in the step that begins with each sample.
    struct RawRange {
        double acceleration_low_mgal, acceleration_high_mgal;
        double temperature_low_degc, temperature_high_degc;
    };

    std::string serial_number;  ///< Of the sensor; empty: not told.
    std::string begins_with;    ///< What is new from here on, "another sensor: ..."; empty: a gap.
    std::vector<UtcTime> times;
    std::vector<double> acceleration_mgal;  ///< Norm of the decimated axes.
    /// x, y, z as the sensor gave them, tide and all; none where the record has only their norm.
    std::vector<std::vector<double>> axes_mgal;
    std::vector<double> temperature_degc;
    std::vector<RawRange> raw;

    [[nodiscard]] std::size_t size() const noexcept { return times.size(); }
};

struct LongRecord {
    std::filesystem::path source;          ///< File or data root it was read from; empty: joined.
    std::vector<RecordStretch> stretches;  ///< In order of time; each at least one sample.
    double raw_rate_hz = 0.0;
    double step_s = kRecordStep_s;  ///< Between samples, on the sensor's clock.
    bool is_tide_removed = false;
    std::vector<text::InputFile> inputs;
    std::vector<std::string> warnings;  ///< What was passed over, and why.
};

}  // namespace a351::corrector
