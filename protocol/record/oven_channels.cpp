#include "protocol/record/oven_channels.hpp"

#include <cmath>

namespace a351::record {
namespace {

// An arrival that a poll is timed by may be late by a pause of the host; a clock that goes back by
// more was set.
constexpr std::chrono::seconds kMostJitter{2};

std::int32_t hundredths(Percent value) {
    return static_cast<std::int32_t>(std::lround(100.0 * value.value()));
}
std::int32_t thousandths(DegC value) {
    return static_cast<std::int32_t>(std::lround(1000.0 * value.value()));
}

}  // namespace

void OvenChannels::add(const RecordContext& context, const OvenSample& sample) {
    if (newest_) {
        const auto behind = *newest_ - sample.second;
        const bool is_had = behind.count() == 0 && !unsettled_;
        if (is_had || (behind.count() > 0 && behind <= kMostJitter)) return;
        if (behind.count() != 0) store(context);
    }
    newest_ = sample.second;
    unsettled_ = sample;
}

void OvenChannels::settle(const RecordContext& context, std::chrono::sys_seconds second) {
    if (unsettled_ && unsettled_->second <= second) store(context);
}

void OvenChannels::store(const RecordContext& context) {
    if (!unsettled_) return;
    const auto& [second, values, index] = *unsettled_;
    if (values.process_value)
        temperature_.add(context, {second, thousandths(*values.process_value), index});
    set_point_.add(context, {second, thousandths(values.set_point), index});
    heating_.add(context, {second, hundredths(values.heating), index});
    unsettled_.reset();
}

void OvenChannels::pass(const RecordContext& context, UtcTime now) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_}) packer->pass(context, now);
}

void OvenChannels::close(const RecordContext& context, bool ends_series) {
    for (SecondPacker* packer : {&temperature_, &set_point_, &heating_})
        packer->close(context, ends_series);
}

}  // namespace a351::record
