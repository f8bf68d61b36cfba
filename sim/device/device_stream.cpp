#include "sim/device/device_stream.hpp"

#include <algorithm>

namespace a351::sim {

DeviceStream::DeviceStream(SampleSource& source, RegisterMachine& machine, SentHandler on_sent)
    : source_(source), machine_(machine), on_sent_(std::move(on_sent)) {}

int DeviceStream::repeats() const {
    return std::max(1, machine_.output_rate_hz() / source_.rate_hz());
}

UtcTime DeviceStream::instant() const {
    return (held_ ? held_->instant : *source_.next_instant()) +
           from_seconds(static_cast<double>(repeat_) / machine_.output_rate_hz());
}

std::optional<UtcTime> DeviceStream::next_due() const {
    if (!held_ && !source_.next_instant()) return std::nullopt;
    return machine_.is_sampling() ? instant() + machine_.frame_delay() : instant();
}

void DeviceStream::advance_to(UtcTime simulated) {
    while (pending().size() < kMostPending) {
        const std::optional<UtcTime> due = next_due();
        if (!due || *due > simulated) return;
        TruthRecord truth;
        truth.utc = instant();
        if (!held_) held_ = source_.next();
        truth.grid_index = static_cast<std::uint32_t>(held_->index);
        if (const auto values = machine_.sample(held_->values, queue_)) {
            truth.values = *values;
            truth.sampling_run = static_cast<std::uint16_t>(machine_.sampling_run());
            frames_.push_back({handed_over_ + pending().size(), *due, truth});
        }
        if (++repeat_ >= repeats()) {
            held_.reset();
            repeat_ = 0;
        }
    }
}

void DeviceStream::receive(std::span<const std::byte> bytes, Nanoseconds now) {
    machine_.receive(bytes, now, queue_);
}

std::span<const std::byte> DeviceStream::pending() const noexcept {
    return std::span(queue_).subspan(queue_start_);
}

void DeviceStream::handed_over(std::size_t byte_count, UtcTime simulated) {
    queue_start_ += byte_count;
    handed_over_ += byte_count;
    while (!frames_.empty() && frames_.front().end <= handed_over_) {
        const Queued& frame = frames_.front();
        if (frame.truth.sampling_run != last_run_) {
            last_run_ = frame.truth.sampling_run;
            report_.runs.push_back({frame.truth.grid_index, 0});
        }
        ++report_.runs.back().frames;
        ++report_.frames_sent;
        report_.largest_lateness =
            std::max<Nanoseconds>(report_.largest_lateness, simulated - frame.due);
        on_sent_(frame.truth);
        frames_.pop_front();
    }
    if (queue_start_ < queue_.size() && queue_start_ < kMostPending) return;
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(queue_start_));
    queue_start_ = 0;
}

}  // namespace a351::sim
