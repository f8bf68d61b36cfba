#include "protocol/archive/slow_channels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace a351::archive {
namespace {

using std::chrono::seconds;

// Share of a second's samples that surely lie within it: the clocks of sensor and host agree to
// 100 ppm, and published times are pulled by 200 ppm at most.
constexpr double kSurelyWithin = 0.999;

bool fits(std::int64_t counts) {
    using Limits = std::numeric_limits<std::int32_t>;
    return counts >= Limits::min() && counts <= Limits::max();
}

// Largest backward step of poll times that is not a set clock: a pause of the host may delay the
// arrival from which a poll is timed.
constexpr seconds kMostJitter{2};

// Largest distance of a poll from the place of its sample.  Polls wander by milliseconds, some by
// pauses of a busy host; with these limits two polls in a row keep their places in any phase.  At
// an interval of 1 s the limit is little more than half: a poll after a failed one must begin a new
// row and not take the second of the failed one.
constexpr Nanoseconds kMostAside = seconds(1);
constexpr Nanoseconds kMostAsideAtOneSecond = std::chrono::milliseconds(600);

std::int32_t thousandths(DegC value) {
    return static_cast<std::int32_t>(std::lround(1000.0 * value.value()));
}

}  // namespace

OvenChannels::OvenChannels(journal::OvenPlace place, seconds interval)
    : place_(place),
      interval_(interval),
      temperature_(place == journal::OvenPlace::inner ? kOvenTemperature : kOuterTemperature,
                   interval),
      set_point_(place == journal::OvenPlace::inner ? kOvenSetPoint : kOuterSetPoint, interval),
      heating_(place == journal::OvenPlace::inner ? kOvenHeating : kOuterHeating, interval) {}

void OvenChannels::add(const RecordContext& context, const OvenSample& sample) {
    auto second = std::chrono::round<seconds>(sample.utc);
    if (newest_) {
        const auto expected = *newest_ + interval_;
        const auto most_aside = interval_ > kMostAside ? kMostAside : kMostAsideAtOneSecond;
        if (std::chrono::abs(sample.utc - expected) < most_aside) second = expected;
        if (second < expected && *newest_ - second <= kMostJitter) return;
    }
    newest_ = second;
    const auto& values = sample.values;
    if (values.process_value)
        temperature_.add(context, {second, thousandths(*values.process_value), sample.index});
    set_point_.add(context, {second, thousandths(values.set_point), sample.index});
    const auto hundredths = static_cast<std::int32_t>(std::lround(100.0 * values.heating.value()));
    heating_.add(context, {second, hundredths, sample.index});
}

void OvenChannels::pass(const RecordContext& context, UtcTime now) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_}) packer->pass(context, now);
}

void OvenChannels::close(const RecordContext& context, bool ends_series) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_})
        packer->close(context, ends_series);
}

SlowChannels::SlowChannels(const wire::DeviceProfile& profile, const RecordContext& context)
    : profile_(profile),
      context_(context),
      sensor_temperature_(kSensorTemperature),
      timing_quality_(kTimingQuality),
      clock_error_(kClockError) {}

void SlowChannels::begin_run(std::string reference, bool has_temperature) {
    reference_ = std::move(reference);
    has_temperature_ = has_temperature;
    waiting_.clear();
    waiting_polls_.clear();
    second_.reset();
    sensor_temperature_ = SecondPacker(kSensorTemperature);
    timing_quality_ = SecondPacker(kTimingQuality);
    clock_error_ = SecondPacker(kClockError);
    for (OvenChannels& oven : ovens_) oven.restart(oven.interval());
}

void SlowChannels::use_oven_interval(journal::OvenPlace place, seconds interval) {
    OvenChannels& oven = of(place);
    if (interval == oven.interval()) return;
    oven.close(context_, true);
    oven.restart(interval);
}

void SlowChannels::add(std::int64_t index, std::int32_t temperature_counts) {
    waiting_.push_back({index, temperature_counts});
    if (!context_.clock.is_fixed(index)) return;
    for (const Waiting& sample : waiting_) take(sample);
    waiting_.clear();
    for (const WaitingPoll& poll : waiting_polls_) take(poll);
    waiting_polls_.clear();
}

void SlowChannels::add(std::int64_t index, Nanoseconds after, const journal::OvenChunk& poll) {
    if (poll.outcome != journal::OvenOutcome::answered) return;
    const auto values = oven::controller_values(poll.registers, poll.decimals);
    if (!values) return;
    if (context_.clock.is_fixed(index))
        take({index, after, *values, poll.place});
    else
        waiting_polls_.push_back({index, after, *values, poll.place});
}

void SlowChannels::take(const WaitingPoll& poll) {
    const UtcTime utc = context_.clock.time_of(poll.index)->utc + poll.after;
    of(poll.place).add(context_, {utc, poll.values, poll.index});
}

void SlowChannels::take(const Waiting& sample) {
    const auto jump = context_.clock.last_break();
    const bool is_jump = second_ && jump && *jump > second_->last_index && *jump <= sample.index;
    if (!second_ || is_jump || sample.index >= second_->next_look)
        look(sample.index, second_ && !is_jump);
    second_->temperature_sum += sample.temperature_counts;
    ++second_->sample_count;
    second_->last_index = sample.index;
}

/// Finds the second of a sample; finishes the one before.
/// @param is_entered  the second of the sample before is known.
void SlowChannels::look(std::int64_t index, bool is_entered) {
    const UtcTime time = context_.clock.time_of(index)->utc;
    const auto begin = std::chrono::floor<seconds>(time);
    if (!is_entered || begin != second_->begin) {
        if (is_entered && second_->is_whole) finish(*second_);
        second_ = Second{};
        second_->begin = begin;
        second_->is_whole = is_entered;
    }
    const double left_s = seconds_between(time, begin + seconds(1));
    const double surely = std::floor(kSurelyWithin * left_s * context_.header.nominal_rate.value());
    second_->next_look = index + std::max<std::int64_t>(1, static_cast<std::int64_t>(surely));
}

void SlowChannels::finish(const Second& second) {
    const auto time = *context_.clock.time_of(second.last_index);
    timing_quality_.add(
        context_, {second.begin, timing_quality_percent(time.uncertainty), second.last_index});
    if (!has_temperature_) return;
    const double mean_counts =
        static_cast<double>(second.temperature_sum) / static_cast<double>(second.sample_count);
    const std::int64_t millidegrees =
        std::llround(1000.0 * (profile_.temperature_offset_degc +
                               profile_.temperature_slope_degc * mean_counts));
    if (!fits(millidegrees)) return;
    sensor_temperature_.add(
        context_, {second.begin, static_cast<std::int32_t>(millidegrees), second.last_index});
}

void SlowChannels::pass(UtcTime now) {
    for (SecondPacker* packer : {&sensor_temperature_, &timing_quality_, &clock_error_})
        packer->pass(context_, now);
    for (OvenChannels& oven : ovens_) oven.pass(context_, now);
}

void SlowChannels::close(bool ends_series) {
    for (SecondPacker* packer : {&sensor_temperature_, &timing_quality_, &clock_error_})
        packer->close(context_, ends_series);
    for (OvenChannels& oven : ovens_) oven.close(context_, ends_series);
}

void SlowChannels::record(const std::string& channel, const PackedRecord& record,
                          std::int64_t last_index) {
    context_.sink.record(channel, record, last_index);
    if (channel != reference_) return;
    const double rate_hz = context_.header.rate_hz();
    const Nanoseconds period = from_seconds(1.0 / rate_hz);
    const std::int64_t first_index =
        last_index + 1 - static_cast<std::int64_t>(record.sample_count);
    const UtcTime end = context_.clock.time_of(last_index)->utc + period;
    for (auto second = std::chrono::ceil<seconds>(record.start); second < end;
         second += seconds(1)) {
        const auto sample = std::min<std::int64_t>(
            static_cast<std::int64_t>(seconds_between(record.start, second) * rate_hz),
            last_index - first_index);
        const UtcTime by_header =
            record.start + from_seconds(static_cast<double>(sample) / rate_hz);
        const Nanoseconds error = context_.clock.time_of(first_index + sample)->utc - by_header;
        const auto error_us = std::chrono::round<std::chrono::microseconds>(error).count();
        if (fits(error_us))
            clock_error_.add(context_,
                             {second, static_cast<std::int32_t>(error_us), first_index + sample});
    }
}

std::optional<std::size_t> SlowChannels::samples_in_archive(const std::string& channel,
                                                            UtcTime start) const {
    return context_.sink.samples_in_archive(channel, start);
}

}  // namespace a351::archive
