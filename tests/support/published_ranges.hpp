#pragma once
/// @file
/// Accepted ranges of the statistics of simulated nights indoors, as means over ten seeds or more.
/// They are the ranges of indoor_statistics.cpp, which computes them independently, under the
/// product's keys.

#include <array>
#include <string_view>

namespace a351::sim {

struct PublishedRange {
    std::string_view key;  ///< Key in the result.json of `a351-correct record`.
    double low, high;
};

inline constexpr std::array<PublishedRange, 15> kPublishedRanges{{
    {"band_period_s", 700.0, 1050.0},
    {"band_temperature_swing_degc", 0.010, 0.025},
    {"band_acceleration_swing_mgal", 3.5, 7.0},
    {"raw_slope_mgal_per_degc", 80.0, 180.0},
    {"raw_r2", 0.15, 0.40},
    {"band_slope_mgal_per_degc", 200.0, 310.0},
    {"band_r2", 0.35, 0.65},
    {"band_negative_delay_s", 220.0, 300.0},
    {"band_positive_delay_s", -260.0, -120.0},
    {"band_peak_ratio", 0.9, 1.1},
    {"mode_slope_mgal_per_degc", 180.0, 360.0},
    {"mode_r2", 0.2, 0.6},
    {"mode_negative_delay_s", 220.0, 300.0},
    {"trend_slope_mgal_per_degc", 0.0, 1e9},
    // The plant's transfer function at 900 s has 271 mGal/degC at +76 degrees.
    {"band_phase_deg", 66.0, 86.0},
}};

}  // namespace a351::sim
