#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace a351::wire {

/// Result of the test that the sensor makes of itself at each start-up, in the order of seriousness
/// (M-A352AD10 data sheet 7.3).
///
/// A read of DIAG_STAT clears it.  A later read therefore says nothing of the test, and an answer
/// that was lost on the line has taken the result with it.  A reset repeats the test.
enum class StartUpTest : std::uint8_t {
    passed,       ///< No error was reported.
    unknown,      ///< The answer was lost.
    flash_error,  ///< FLASH_ERR: the sensor may lack its calibration.
    hard_error,   ///< HARD_ERR: the sensor is faulty.
};

/// Returns the result in DIAG_STAT.
[[nodiscard]] StartUpTest start_up_test_in(std::uint16_t diag_stat) noexcept;

/// Returns "passed", "unknown", "FLASH_ERR" or "HARD_ERR".
[[nodiscard]] std::string_view to_text(StartUpTest result) noexcept;

/// Returns the result with this text; std::nullopt if there is none.
[[nodiscard]] std::optional<StartUpTest> start_up_test_named(std::string_view text) noexcept;

}  // namespace a351::wire
