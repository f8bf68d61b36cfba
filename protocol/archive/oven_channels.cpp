#include "protocol/archive/oven_channels.hpp"

#include <cmath>

namespace a351::record {
namespace {

// Largest backward step of poll times that is not a set clock: a pause of the host may delay the
// arrival from which a poll is timed.
constexpr std::chrono::seconds kMostJitter{2};

// Largest distance of a poll from the place of its sample.  Polls wander by milliseconds, some by
// pauses of a busy host; with these limits two polls in a row keep their places in any phase.  At
// an interval of 1 s the limit is little more than half: a poll after a failed one must begin a new
// row and not take the second of the failed one.
constexpr Nanoseconds kMostAside = std::chrono::seconds(1);
constexpr Nanoseconds kMostAsideAtOneSecond = std::chrono::milliseconds(600);

std::int32_t hundredths(Percent value) {
    return static_cast<std::int32_t>(std::lround(100.0 * value.value()));
}
std::int32_t thousandths(DegC value) {
    return static_cast<std::int32_t>(std::lround(1000.0 * value.value()));
}

}  // namespace

void OvenChannels::add(const RecordContext& context, const OvenSample& sample) {
    auto second = std::chrono::round<std::chrono::seconds>(sample.utc);
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
