#pragma once
/// @file
/// Segments of the archive on a regular grid.
///
/// The archive has segments of counts with time stamps.  A series has values on a regular grid, with
/// NaN where there is no sample.  Samples are moved to the nearest instant of the grid, never
/// interpolated; for values at round instants of UTC see utc_grid.hpp.  The functions are pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::corrector::archive_series {

/// Samples of a segment with their numbers, which are consecutive.
struct NumberedSamples {
    std::span<const std::int32_t> counts;
    std::int64_t first = 0;  ///< Number of the first sample.

    /// Returns the number after the last one.
    [[nodiscard]] std::int64_t end() const {
        return first + static_cast<std::int64_t>(counts.size());
    }
};

/// Values of one fill() in a long series, so that a block fits into the cache.
inline constexpr std::size_t kBlockSamples = 16384;

/// Sets the values numbered `at` and more: offset + gain x count, NaN where no sample has the
/// number.  If several samples have a number, the last one in the list counts.
void fill(std::span<double> values, std::int64_t at, const std::vector<NumberedSamples>& samples,
          double gain, double offset);

/// The instants origin + i / rate, i = 0 ... count - 1.
/// A default-constructed grid is empty and must not be used.
struct SampleGrid {
    UtcTime origin;         ///< Instant of sample 0.
    double rate_hz = 0.0;   ///< Rate, Hz, > 0.
    std::size_t count = 0;  ///< Number of instants, >= 1.
};

/// Returns the grid on which the sensor sampled between two instants.
///
/// The grid starts at the first sample within [start, end).  Its rate is that between the time
/// stamps of the longest piece, so that a sensor with a rate error of some ppm loses no sample;
/// tested at 80 ppm (tests/unit/archive_series/sample_grid_test.cpp).  If these stamps span less
/// than 60 s, it is the rate of the header, because then the rounding of the stamps is the larger
/// error.
///
/// @param segments    of one channel, in any order; each has an anchor at its first sample.
/// @param start, end  window [start, end); start <= end, which is not checked.
/// @return the grid up to `end`; std::nullopt without a sample in the window.  The last instant is
///         0.5 to 1.5 samples before `end`, so that rounded stamps do not change the count.
[[nodiscard]] std::optional<SampleGrid> sampling_grid(const std::vector<archive::Segment>& segments,
                                                      UtcTime start, UtcTime end);

/// Numbers segments by the instants of the grid.  A segment is placed by its first sample and not
/// divided.
///
/// Samples more than half a step before the origin are left out.  The first of the others is put at
/// the nearest instant, and those after it follow one by one.  Within a segment no sample is lost
/// or doubled.  After a long segment at another rate they are off their instants by the drift.
///
/// @param segments  of one channel, in order of time; must outlive the result.
/// @return the samples for fill(), which may be numbered beyond the last instant.
[[nodiscard]] std::vector<NumberedSamples> number_on_grid(
    const std::vector<archive::Segment>& segments, const SampleGrid& grid);

/// Returns the values at all instants: fill() of number_on_grid().  Samples beyond the last instant
/// are left out.
/// @param scale  gain and offset of the channel.
/// @return (grid.count) values in the unit of the scale.
[[nodiscard]] std::vector<double> place_on_grid(const std::vector<archive::Segment>& segments,
                                                const station::ChannelScale& scale,
                                                const SampleGrid& grid);

}  // namespace a351::corrector::archive_series
