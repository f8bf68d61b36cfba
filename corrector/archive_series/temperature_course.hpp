#pragma once
/// @file
/// A temperature in means of one minute: that of a survey for figures and tables, that of an outer oven
/// for the correction.
///
/// The sensor's own temperature in the correction is day_temperature(), which has no gaps and the noise
/// smoothed.  The thermometer of an outer oven is coarse and lags its wall by minutes, so that straight
/// lines between minutes are good enough.

#include <chrono>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::corrector::archive_series {

/// The mean temperature of one minute.
/// It has at least one sample.
struct MinuteTemperature {
    UtcTime middle;  ///< Middle of a minute of UTC.
    DegC mean;       ///< Mean of its samples.
};

/// Returns a temperature in means of one minute, in order of time; minutes without a
/// sample are left out.
///
/// Minutes are whole minutes of UTC.  The time of a sample is counted from the time stamp of its
/// record, so a sensor off its nominal rate is right too.  Counts are summed as integers, hence
/// exactly.
///
/// A gap gives missing minutes and nothing else; there is no NaN.  Two segments with samples in one
/// minute give one mean.  The time is O(n log m) for n samples and m minutes.
///
/// @param segments  counts of the temperature channel, with time stamps; any order.  Each segment
///                  needs rate_hz > 0; one without a time stamp is left out.
/// @param scale     degC = offset + gain x count.
/// @return one mean for each minute with a sample; empty without samples.
[[nodiscard]] std::vector<MinuteTemperature> temperature_course(
    const std::vector<archive::Segment>& segments, const station::ChannelScale& scale);

/// Longest gap in the means of an outer oven that a straight line bridges: half the expected lag.
/// The lag damps the difference between the line and the true course.
inline constexpr std::chrono::minutes kLongestOuterGap(10);

/// Returns true if the longest time without a mean between two instants, both included, is at most
/// kLongestOuterGap.
/// @param course  in order of time.
[[nodiscard]] bool is_without_gaps(const std::vector<MinuteTemperature>& course, UtcTime from,
                                   UtcTime to);

/// Returns the temperature at some instants: a straight line between two means, constant before the
/// first and after the last; NaN where the means are further apart or there is none.
/// @param course  in order of time.
/// @param times   in order of time.
/// @param gap     longest time between two means, or from an end to an instant.
[[nodiscard]] std::vector<double> interpolated(const std::vector<MinuteTemperature>& course,
                                               const std::vector<UtcTime>& times, Nanoseconds gap);

}  // namespace a351::corrector::archive_series
