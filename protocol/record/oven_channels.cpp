#include "protocol/record/oven_channels.hpp"

#include <cmath>

namespace a351::record {
namespace {

// An arrival that a poll is timed by may be late by a pause of the host; a clock that goes back by
// more was set.
constexpr std::chrono::seconds kMostJitter{2};

// Polls wander by milliseconds; rounded to a second that is one second.
constexpr std::chrono::seconds kMostAside{1};

std::int32_t hundredths(Percent value) {
    return static_cast<std::int32_t>(std::lround(100.0 * value.value()));
}
std::int32_t thousandths(DegC value) {
    return static_cast<std::int32_t>(std::lround(1000.0 * value.value()));
}

}  // namespace

void OvenChannels::add(const RecordContext& context, const OvenSample& sample) {
    std::chrono::sys_seconds second = sample.second;
    if (newest_) {
        const auto expected = *newest_ + interval_;
        if (interval_ > kMostAside && std::chrono::abs(second - expected) <= kMostAside)
            second = expected;
        if (second < expected && *newest_ - second <= kMostJitter) return;
    }
    newest_ = second;
    const auto& values = sample.values;
    if (values.process_value)
        temperature_.add(context, {second, thousandths(*values.process_value), sample.index});
    set_point_.add(context, {second, thousandths(values.set_point), sample.index});
    heating_.add(context, {second, hundredths(values.heating), sample.index});
}

void OvenChannels::pass(const RecordContext& context, UtcTime now) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_}) packer->pass(context, now);
}

void OvenChannels::close(const RecordContext& context, bool ends_series) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_})
        packer->close(context, ends_series);
}

}  // namespace a351::record
