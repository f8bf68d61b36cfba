#pragma once
/// @file
/// The user FIR filter of the emulated sensor: its coefficients are read and written byte by byte
/// through FIR_UCMD, FIR_UDATA and FIR_UADDR.  M-A352AD10 data sheet, rev. 20251023, 5.17.2,
/// 7.16-7.18, table 2.4.

#include <chrono>
#include <cstdint>
#include <span>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

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

}  // namespace a351::sim
