#include "sim/device/self_test.hpp"

#include <bit>
#include <cmath>

#include "protocol/wire/registers.hpp"

namespace a351::sim::device {
namespace {

// High byte of MSC_CTRL (7.10).
constexpr unsigned kSensitivityTests = 0x70;  // Z, Y, X.
constexpr unsigned kFlashTest = 0x08;
constexpr unsigned kAccelerationTest = 0x04;
constexpr unsigned kTemperatureTest = 0x02;
constexpr unsigned kSupplyTest = 0x01;
constexpr unsigned kTogether = kAccelerationTest | kTemperatureTest | kSupplyTest;

constexpr double kLeastVector_g = 0.8;  // Section 5.7.
constexpr double kLargestVector_g = 1.2;

bool is_resting(const signal::SensorSample& sample, const wire::DeviceProfile& profile) {
    double sum = 0.0;
    for (const std::int32_t counts : sample.axes_counts) {
        const double g = profile.acceleration(counts).value();
        sum += g * g;
    }
    const double length_g = std::sqrt(sum);
    return length_g >= kLeastVector_g && length_g <= kLargestVector_g;
}

}  // namespace

void SelfTest::start(std::uint8_t high_byte, Nanoseconds now) {
    const unsigned wanted = high_byte & (kSensitivityTests | kFlashTest | kTogether);
    if (running_ != 0 || wanted == 0) return;
    if ((wanted & ~kTogether) != 0 && std::popcount(wanted) > 1) return;
    running_ = static_cast<std::uint8_t>(wanted);
    ends_at_ = now;
    if ((wanted & kSensitivityTests) != 0) {
        ends_at_ += kSensitivityTestTime;
    } else if (wanted == kFlashTest) {
        ends_at_ += kFlashTestTime;
    } else {
        ends_at_ += kShortTestTime;
    }
}

std::uint16_t SelfTest::end_due(Nanoseconds now, std::uint16_t failing,
                                const std::optional<signal::SensorSample>& sample,
                                const wire::DeviceProfile& profile) {
    if (running_ == 0 || now < ends_at_) return 0;
    unsigned raised = 0;
    if ((running_ & kAccelerationTest) != 0) {
        raised |= failing & (kDiagAccelerationVector | kDiagAxes);
        if (sample && !is_resting(*sample, profile)) raised |= kDiagAccelerationVector;
        if (raised != 0) raised |= kDiagAccelerationAny;
    }
    if ((running_ & kSensitivityTests) != 0) raised |= failing & kDiagSensitivity;
    if ((running_ & kTemperatureTest) != 0) raised |= failing & kDiagTemperature;
    if ((running_ & kSupplyTest) != 0) raised |= failing & kDiagSupply;
    if ((running_ & kFlashTest) != 0) raised |= failing & wire::kDiagFlashError;
    running_ = 0;
    return static_cast<std::uint16_t>(raised);
}

}  // namespace a351::sim::device
