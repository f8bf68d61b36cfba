#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/device/register_machine.hpp"

namespace a351::sim::device {
namespace {

constexpr std::size_t kAxes = 3;

// FLAG (7.4): bits of X; those of Y and Z are one and two bits lower.  SIG_CTRL enables ND with the
// same bits (7.9).
constexpr std::uint16_t kNewTemperature = 0x8000;
constexpr unsigned kNewX = 0x0800;
constexpr unsigned kAlarmX = 0x0010;
constexpr unsigned kTiltX = 0x0080;  // SIG_CTRL: OUTPUT_SEL_X; Y and Z likewise.

constexpr std::uint16_t kLongFilterHigh = 0x0002;  // LONGFILT_CTRL: FILT_SEL.

constexpr std::int64_t kBitsPerByte = 10;  // Start bit, eight bits, stop bit (table 6.7).

/// Returns the number of samples that fill the FIR filter and are not sent.  All numbers of table
/// 5.3 are 2^n - 1, where 2^n is the next power of two at or above taps / decimation.
int suppressed_samples(int taps, int decimation) {
    const auto filled = static_cast<unsigned>((taps + decimation - 1) / decimation);
    return static_cast<int>(std::bit_ceil(filled)) - 1;
}

std::uint16_t without(std::uint16_t value, unsigned bits) {
    return static_cast<std::uint16_t>(value & ~bits);
}

}  // namespace

const wire::FilterSpec& RegisterMachine::filter() const {
    const std::uint16_t code = registers_.at(wire::kFilterCtrl) & wire::kFilterSelect;
    return *profile_.filter_coded(static_cast<std::uint8_t>(code));
}

std::optional<wire::BurstLayout> RegisterMachine::layout() const {
    return wire::BurstLayout::from_burst_ctrl(registers_.at(wire::kBurstCtrl));
}

bool RegisterMachine::sends_tilt(std::size_t axis) const {
    return has(wire::kSigCtrl, static_cast<std::uint16_t>(kTiltX >> axis));
}

std::int64_t RegisterMachine::frame_bits() const {
    const auto shape = layout();
    return shape ? static_cast<std::int64_t>(shape->frame_size()) * kBitsPerByte : 0;
}

Nanoseconds RegisterMachine::frame_delay() const {
    return profile_.group_delay(filter()) + profile_.data_ready_delay +
           transmit_.next_wait(baud(), output_rate_hz()) +
           Nanoseconds(frame_bits() * 1'000'000'000 / baud());
}

void RegisterMachine::start_sampling() {
    is_sampling_ = true;
    ++sampling_run_;
    registers_.at(wire::kModeCtrl) = 0;
    registers_.at(kCount) = 0;
    new_data_ = alarms_ = 0;
    is_triggered_ = false;
    transmit_.clear();
    // Registers are not updated during the transient only with the internal timer (5.17.3).
    transient_left_ =
        has(wire::kMscCtrl, wire::kMscExternalTrigger)
            ? 0
            : suppressed_samples(filter().taps, profile_.count_step(output_rate_hz()));
    using Kind = LongTermFilter::Kind;
    const Kind chosen = has(kLongFilter, kLongFilterHigh) ? Kind::high_pass : Kind::low_pass;
    long_filter_.start(has(kLongFilter, kLongFilterOn) ? chosen : Kind::off,
                       registers_.at(kLongFilterTaps));
}

void RegisterMachine::jump_counter(unsigned ticks) {
    registers_.at(kCount) = static_cast<std::uint16_t>((registers_.at(kCount) + ticks) & 0xFFFFU);
}

/// Passes one period of the output rate; returns false if it gives no sample.
bool RegisterMachine::begin_sample() {
    if (!is_sampling_) return false;
    transmit_.pass_period(baud());
    if (transient_left_ > 0) {
        --transient_left_;
        return false;
    }
    jump_counter(profile_.count_step(output_rate_hz()));
    return true;
}

void RegisterMachine::skip_sample() { static_cast<void>(begin_sample()); }

std::optional<wire::BurstValues> RegisterMachine::sample(const signal::SensorSample& sample,
                                                         std::vector<std::byte>& frames) {
    latest_ = sample;
    if (!begin_sample()) return std::nullopt;
    if (has(wire::kMscCtrl, wire::kMscExternalTrigger) && !std::exchange(is_triggered_, false))
        return std::nullopt;
    store(sample);
    const auto shape = layout();
    if (!has(wire::kUartCtrl, wire::kUartAuto) || !shape) return std::nullopt;
    if (!transmit_.take(frame_bits(), output_rate_hz())) {
        raise_diagnostics(wire::kDiagUartOverflow);
        return std::nullopt;
    }
    const wire::BurstValues values = take_values(*shape);
    wire::append_frame(*shape, values, frames);
    return values;
}

std::array<std::int32_t, 3> RegisterMachine::filtered(const signal::SensorSample& sample) {
    using Limits = std::numeric_limits<std::int32_t>;
    std::array<std::int32_t, 3> counts = sample.axes_counts;
    for (std::int32_t& axis : counts) {
        const double gained = std::round(user_gain_ * axis);
        axis = static_cast<std::int32_t>(std::clamp<double>(gained, Limits::min(), Limits::max()));
    }
    return long_filter_.next(counts);
}

void RegisterMachine::store(const signal::SensorSample& sample) {
    registers_.put32(kTemperature, sample.temperature_counts);
    const std::array<std::int32_t, 3> counts = filtered(sample);
    const bool is_invalid = is_aliased_ && !has(wire::kMscCtrl, wire::kMscExternalTrigger);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        const std::uint16_t limits = registers_.at(kAlarm, axis);
        const LimitedAxis output =
            limited_axis(counts[axis],
                         {registers_.get32(kOffset, axis), static_cast<std::int8_t>(limits >> 8U),
                          static_cast<std::int8_t>(limits & 0xFFU)},
                         profile_);
        const std::int32_t acceleration = is_invalid ? kAliasedCounts : output.acceleration_counts;
        registers_.put32(kAcceleration, acceleration, axis);
        if (sends_tilt(axis)) {
            registers_.put32(
                kTilt, is_invalid ? kAliasedCounts : tilt_counts(acceleration, profile_), axis);
        }
        if (output.is_alarmed && !is_invalid)
            alarms_ = static_cast<std::uint16_t>(alarms_ | kAlarmX >> axis);
    }
    new_data_ = registers_.at(wire::kSigCtrl) & wire::kSigNewDataEnables;
}

std::uint16_t RegisterMachine::flag() const {
    unsigned flag = new_data_ | alarms_;
    if (is_aliased_) flag |= wire::kFlagAliasing;
    if (registers_.at(wire::kDiagStat) != 0) flag |= wire::kFlagError;
    return static_cast<std::uint16_t>(flag);
}

/// Returns the values of the frame for the sample in the registers; each field counts as read.
wire::BurstValues RegisterMachine::take_values(const wire::BurstLayout& layout) {
    wire::BurstValues values;
    if (layout.has_flag()) values.flag = flag();
    values.temperature = registers_.get32(kTemperature);
    values.count = registers_.at(kCount);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        values.axes[axis] = registers_.get32(sends_tilt(axis) ? kTilt : kAcceleration, axis);
        if (layout.has_axis(static_cast<wire::Axis>(axis)))
            new_data_ = without(new_data_, kNewX >> axis);
    }
    if (layout.has_temperature()) new_data_ = without(new_data_, kNewTemperature);
    if (layout.has_flag()) alarms_ = 0;
    return values;
}

/// Clears the bits that a read of a register of window 0 clears (table 7.1; 7.3, 7.4).
void RegisterMachine::clear_after_read(std::uint8_t address) {
    if (address == wire::kDiagStat.address) clear_diagnostics();
    if (address == wire::kFlag.address) alarms_ = 0;
    constexpr unsigned kBytesPerValue = 4;
    if (address - unsigned{kTemperature.address} < kBytesPerValue)
        new_data_ = without(new_data_, kNewTemperature);
    // Three axes of acceleration, then three of tilt.
    const unsigned value = (address - unsigned{kAcceleration.address}) / kBytesPerValue;
    if (value < 2 * kAxes) new_data_ = without(new_data_, kNewX >> value % kAxes);
}

}  // namespace a351::sim::device
