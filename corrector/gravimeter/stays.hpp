#pragma once
/// @file
/// From readings of gravimeters to stays, one average each.
///
///     std::vector<GravimeterFile> files{read_gravimeter_file("b44.txt")};
///     const std::vector<Stay> stays = find_stays(files);
///     const StayAverage average = average_of(stays.front(), {});
///
/// A stay is a run of readings of one instrument at one station, at one setting of the dial, with or
/// without the tide correction, and
/// without a pause of more than kLongestPause.  Setting the dial begins another loop, because the
/// constant of the instrument changes, and so does the end of a loop in a file that marks it.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "corrector/gravimeter/gravimeter_file.hpp"

namespace a351::corrector::gravimeter {

/// Longest pause between two readings of one stay.  Reason: an instrument that is levelled again or
/// waits for steady readings takes less; after more it has usually been moved.
inline constexpr std::chrono::hours kLongestPause{1};

/// One stay of one instrument.
struct Stay {
    std::string instrument;
    std::string site;
    int occupation = 1;  ///< Number of the stay at this site among all instruments, from 1.
    int loop = 1;        ///< Number of the loop of this instrument, from 1.
    std::vector<const Reading*> readings;  ///< In ascending time, at least one.
};

/// How the readings of a stay become one value.
struct AverageOptions {
    std::size_t last = 8;  ///< Number of readings at its end that are used; 0: all.
    bool is_mean = false;  ///< False: their median.
};

/// The average of a stay.
struct StayAverage {
    UtcTime time;    ///< Mean time of the readings used.
    MilliGal value;  ///< Median or mean, with all corrections of the instrument.
    /// Mean tide correction in `value`; absent if the instrument applied none.
    std::optional<MilliGal> tide_correction;
    std::size_t count = 0;       ///< Number of readings used.
    std::optional<MilliGal> sd;  ///< Standard deviation of one of them; absent for one reading.
};

/// Finds the stays of all instruments, in order of their first reading.
///
/// A second reading of an instrument at one instant is moved to `refused` of its file.
/// @return stays that point to the readings in `files`, which must outlive them.
[[nodiscard]] std::vector<Stay> find_stays(std::vector<GravimeterFile>& files);

/// Averages a stay.
[[nodiscard]] StayAverage average_of(const Stay& stay, const AverageOptions& options);

}  // namespace a351::corrector::gravimeter
