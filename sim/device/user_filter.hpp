#pragma once
/// @file
/// The user's FIR filter of the emulated sensor: coefficients go in and out byte by byte through
/// FIR_UCMD, FIR_UDATA and FIR_UADDR.  M-A352AD10 data sheet, rev. 20251023, 5.17.2, 7.16-7.18,
/// table 2.4.

#include <chrono>
#include <cstdint>
#include <span>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

class UserFilter {
public:
    static constexpr std::chrono::milliseconds kWriteTime{7};  ///< A byte.
    static constexpr std::chrono::microseconds kReadTime{500};
    static constexpr std::uint16_t kFirstAddress = 0x0800;
    static constexpr std::uint16_t kLastAddress = 0x0FFF;

    /// Writing FIR_UCMD: 1 reads the byte at the address to FIR_UDATA, 2 writes it from there; the
    /// address then goes up by one, after the last to the first (the data sheet does not say).
    /// Until that is done, this and the other writes are not taken.
    void start(std::uint8_t command, Nanoseconds now);
    void set_data(std::uint8_t byte);
    void set_address(std::uint16_t address);  ///< kFirstAddress ... kLastAddress.

    /// Ends the command whose time is over.
    /// @param coefficients  The memory from kFirstAddress to kLastAddress.
    /// @param is_readable   False: a byte cannot be read, which DATA_ERR says.
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

/// What a constant input is multiplied by: the sum of the first `taps` coefficients, each a signed
/// fraction of 2^31, least byte first.  The emulator applies only this of the filter, as its
/// samples are slow against any of them.
[[nodiscard]] double constant_gain(std::span<const std::uint8_t> coefficients, int taps);

}  // namespace a351::sim
