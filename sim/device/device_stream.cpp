#include "sim/device/device_stream.hpp"

namespace a351::sim::device {
namespace {

/// Most samples in one call: a device that is hours behind must still answer commands at once.
constexpr int kMostAtOnce = 1024;

}  // namespace

DeviceStream::DeviceStream(signal::SampleSource& source, RegisterMachine& machine)
    : source_(source), machine_(machine) {}

bool DeviceStream::is_holding() const {
    return held_ && held_rate_hz_ == machine_.output_rate_hz();
}

UtcTime DeviceStream::instant() const {
    if (!is_holding()) return *source_.next_instant();
    return held_->instant + from_seconds(static_cast<double>(repeat_) / held_rate_hz_);
}

std::optional<UtcTime> DeviceStream::next_due() const {
    if (!is_holding() && !source_.next_instant()) return std::nullopt;
    return machine_.is_sampling() ? instant() + machine_.frame_delay() : instant();
}

void DeviceStream::receive(std::span<const std::byte> bytes, const Instant& now, LineSink& line) {
    bytes_.clear();
    machine_.receive(bytes, now.steady, bytes_);
    if (!bytes_.empty()) line.send(bytes_, now.simulated, nullptr);
}

void DeviceStream::advance_to(const Instant& now, LineSink& line) {
    machine_.pass_time(now.steady);
    for (int taken = 0; taken < kMostAtOnce && !line.is_full(); ++taken) {
        const std::optional<UtcTime> due = next_due();
        if (!due || *due > now.simulated) return;
        if (!is_holding()) {
            held_ = source_.next();
            held_rate_hz_ = machine_.output_rate_hz();
            repeat_ = 0;
        }
        send_sample(*due, line);
        if (++repeat_ >= held_rate_hz_ / source_.rate_hz()) held_.reset();
    }
}

void DeviceStream::send_sample(UtcTime due, LineSink& line) {
    bytes_.clear();
    const auto values = machine_.sample(held_->values, bytes_);
    if (!values) return;
    const truth::Record truth{instant(), *values,
                              static_cast<std::uint16_t>(machine_.sampling_run()),
                              static_cast<std::uint32_t>(held_->index)};
    line.send(bytes_, due, &truth);
}

}  // namespace a351::sim::device
