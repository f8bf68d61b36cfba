#pragma once
/// @file
/// The long-term filter of the emulated sensor: moving averages of 2^n samples at the output rate.
/// M-A352AD10 data sheet, rev. 20251023, 5.17.4, 7.19, 7.20.

#include <array>
#include <cstdint>
#include <vector>

namespace a351::sim {

/// Low-pass: two moving averages in series.  High-pass: the sample minus one moving average.
/// Averages start filled with zeros, so the transient lasts N samples (high-pass) or 2 N
/// (low-pass), as in table 5.5.  Samples of the transient are sent, because the data sheet
/// suppresses only those of the FIR filter.
class LongTermFilter {
public:
    enum class Kind { off, low_pass, high_pass };

    static constexpr int kHighestRateHz = 500;  ///< Highest rate with the filter on (5.17.4).

    /// Restarts with N = 2^log2_taps; log2_taps is 1 ... 12.
    void start(Kind kind, int log2_taps);

    /// Filters the next sample.
    /// @param axes_counts  the sample, in any unit.
    /// @return             the filtered sample; each average is rounded towards minus infinity.
    [[nodiscard]] std::array<std::int32_t, 3> next(const std::array<std::int32_t, 3>& axes_counts);

private:
    class MovingAverage {
    public:
        explicit MovingAverage(int log2_taps);
        [[nodiscard]] std::int32_t next(std::int32_t value);

    private:
        std::vector<std::int32_t> newest_;  ///< A ring.
        std::size_t oldest_ = 0;
        std::int64_t sum_ = 0;
        int log2_taps_ = 0;
    };

    Kind kind_ = Kind::off;
    std::vector<MovingAverage> averages_;  ///< One per axis (high-pass) or two (low-pass).
};

}  // namespace a351::sim
