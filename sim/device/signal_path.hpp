#pragma once
/// @file
/// Steps of the emulated sensor from a sample to the output.  M-A352AD10 data sheet, rev. 20251023.
/// - User FIR filter: its coefficients are read and written byte by byte through FIR_UCMD,
///   FIR_UDATA and FIR_UADDR (5.17.2, 7.16-7.18, table 2.4).
/// - Long-term filter: moving averages of 2^n samples at the output rate (5.17.4, 7.19, 7.20).
/// - The user's offset, alarm limits and tilt (5.8, 5.12, 5.13, 7.7, 7.8, 7.21-7.26).

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::sim::device {

class UserFilter {
public:
    static constexpr std::chrono::milliseconds kWriteTime{7};   ///< Per byte.
    static constexpr std::chrono::microseconds kReadTime{500};  ///< Per byte.
    static constexpr std::uint16_t kFirstAddress = 0x0800;
    static constexpr std::uint16_t kLastAddress = 0x0FFF;

    /// Takes a write to FIR_UCMD: 1 reads the byte at the address into FIR_UDATA, 2 writes it from
    /// there.  Then the address increases by one; after the last comes the first (the data sheet
    /// does not say).  Until the command ends, this and the other writes are ignored.
    void start(std::uint8_t command, Nanoseconds now);
    void set_data(std::uint8_t byte);
    void set_address(std::uint16_t address);  ///< kFirstAddress ... kLastAddress.

    /// Ends the command whose time is over.
    /// @param coefficients  memory from kFirstAddress to kLastAddress.
    /// @param is_readable   false: a read fails and sets DATA_ERR.
    void end_due(Nanoseconds now, std::span<std::uint8_t> coefficients, bool is_readable);

    void reset() { *this = UserFilter(); }

    // The registers as the host reads them.
    [[nodiscard]] std::uint16_t command() const noexcept { return command_; }
    [[nodiscard]] std::uint16_t data() const noexcept { return data_; }
    [[nodiscard]] std::uint16_t address() const noexcept { return address_; }

private:
    std::uint16_t command_ = 0;
    std::uint16_t data_ = 0;
    std::uint16_t address_ = kFirstAddress;
    Nanoseconds ends_at_{0};
};

/// Returns the gain for a constant input: the sum of the first `taps` coefficients, each a signed
/// multiple of 2^-31, lowest byte first.  The emulator applies only this gain of the filter,
/// because its samples change slowly compared with any such filter.
[[nodiscard]] double constant_gain(std::span<const std::uint8_t> coefficients, int taps);

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

struct AxisSettings {
    std::int32_t offset_counts = 0;  ///< Offset to add, in the format of the acceleration.
    std::int8_t upper_limit_g = 15;
    std::int8_t lower_limit_g = -15;
};

struct LimitedAxis {
    std::int32_t acceleration_counts = 0;  ///< Limited to the two limits.
    bool is_alarmed = false;               ///< The value was beyond a limit, not just at it.
};

/// Returns counts + offset, kept within the limits.
[[nodiscard]] LimitedAxis limited_axis(std::int32_t counts, const AxisSettings& settings,
                                       const wire::DeviceProfile& profile) noexcept;

/// Tilt of +60 degrees, in counts as the device sends it (7.8).
inline constexpr std::int32_t kLargestTiltCounts = 0x2182A470;

/// Returns asin(acceleration / 1 g), limited to +-60 degrees.
[[nodiscard]] std::int32_t tilt_counts(std::int32_t acceleration_counts,
                                       const wire::DeviceProfile& profile) noexcept;

}  // namespace a351::sim::device
