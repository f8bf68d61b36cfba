#include "protocol/wire/start_up_test.hpp"

#include <algorithm>
#include <array>

#include "protocol/wire/registers.hpp"

namespace a351::wire {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 4> kStartUpTexts{"passed", "unknown", "FLASH_ERR",
                                                        "HARD_ERR"};

}  // namespace

StartUpTest start_up_test_in(std::uint16_t diag_stat) noexcept {
    if ((diag_stat & kDiagHardError) != 0) return StartUpTest::hard_error;
    if ((diag_stat & kDiagFlashError) != 0) return StartUpTest::flash_error;
    return StartUpTest::passed;
}

std::string_view to_text(StartUpTest result) noexcept {
    return kStartUpTexts[static_cast<std::size_t>(result)];
}

std::optional<StartUpTest> start_up_test_named(std::string_view text) noexcept {
    const auto found = std::ranges::find(kStartUpTexts, text);
    if (found == kStartUpTexts.end()) return std::nullopt;
    return static_cast<StartUpTest>(found - kStartUpTexts.begin());
}

}  // namespace a351::wire
