#pragma once
/// @file
/// The self tests of the emulated sensor.  M-A352AD10 data sheet, rev. 20251023, 5.7, 7.3, 7.10,
/// table 2.4.

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim::device {

// DIAG_STAT (7.3): the results of tests, and of FLASH_BACKUP and FLASH_RST.
inline constexpr std::uint16_t kDiagAccelerationVector = 0x8000;
inline constexpr std::uint16_t kDiagAxes = 0x7000;  ///< X, Y, Z.
inline constexpr std::uint16_t kDiagSensitivity = 0x0C00;
inline constexpr std::uint16_t kDiagTemperature = 0x0200;
inline constexpr std::uint16_t kDiagSupply = 0x0100;
inline constexpr std::uint16_t kDiagAccelerationAny = 0x0002;  ///< OR of vector and axes.
inline constexpr std::uint16_t kDiagFlashBackup = 0x0001;

class SelfTest {
public:
    static constexpr std::chrono::milliseconds kFlashTestTime{5};
    static constexpr std::chrono::milliseconds kShortTestTime{200};  ///< ACC, TEMP, VDD.
    static constexpr std::chrono::seconds kSensitivityTestTime{10};  ///< Per axis, typical.

    /// Starts tests.  Ignored while a test runs, and for a combination other than of ACC, TEMP and
    /// VDD, because only these may run together (7.10).
    /// @param high_byte  high byte of MSC_CTRL as written.
    void start(std::uint8_t high_byte, Nanoseconds now);

    /// Returns the running tests as the high byte of MSC_CTRL.
    [[nodiscard]] std::uint8_t running() const noexcept { return running_; }

    /// Ends the tests whose time is over.
    /// @param failing  DIAG_STAT bits that their test raises in any case.
    /// @param sample   newest sample: the acceleration test fails if the length of the vector is
    ///                 outside 0.8 ... 1.2 g.  Without a sample the length is not tested.
    /// @return         DIAG_STAT bits that the ended tests raise.
    [[nodiscard]] std::uint16_t end_due(Nanoseconds now, std::uint16_t failing,
                                        const std::optional<signal::SensorSample>& sample,
                                        const wire::DeviceProfile& profile);

    void abort() noexcept { running_ = 0; }

private:
    std::uint8_t running_ = 0;
    Nanoseconds ends_at_{0};
};

}  // namespace a351::sim::device
