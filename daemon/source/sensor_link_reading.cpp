/// @file
/// The sensor's link while the stream runs: what is read goes into the queue.

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>
#include <utility>

#include "daemon/source/sensor_link.hpp"
#include "daemon/source/step_watch.hpp"
#include "protocol/timing/host_clock_rules.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/commands.hpp"

namespace a351::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// A busy host pauses this long without anything being wrong.
constexpr milliseconds kShortestRealStall{1000};
// Of instrument time.
constexpr seconds kSilenceIsStall{2};
constexpr seconds kBabbleIsStall{3};
// Of real time.
constexpr milliseconds kStopCheck{200};
constexpr milliseconds kQueueRetry{10};
constexpr milliseconds kSilence{50};
constexpr seconds kLongestDrain{1};

}  // namespace

SensorLink::End SensorLink::read_stream() {
    const auto at_least_real = [this](Nanoseconds instrument_span) {
        return std::max<Nanoseconds>(kShortestRealStall, clock_.real_span(instrument_span));
    };
    const auto frame_period = from_seconds(1.0 / options_.settings.output_rate_hz);
    const auto silence = at_least_real(std::max<Nanoseconds>(kSilenceIsStall, 20 * frame_period));
    const auto babble = at_least_real(kBabbleIsStall);

    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    // Only to see that frames come, and at what rate; the archive has its own decoder.
    const auto count_step = options_.profile->count_step(options_.settings.output_rate_hz);
    wire::BurstDecoder decoder(options_.settings.layout, count_step);
    StepWatch watch(count_step);
    auto last_byte = steady_clock::now();
    auto last_frame = last_byte;
    has_frames_ = false;
    while (!stop_) {
        const auto count = port_->read(bytes, kStopCheck);
        RawTime time = clock_.raw();
        if (!count) return End::gone;
        const auto now = steady_clock::now();
        if (*count > 0) {
            std::span<const std::byte> input = std::span(bytes).first(*count);
            if (begun_) begin_session();
            const Nanoseconds slept_before = std::exchange(slept_, clock_.slept());
            if (slept_ - slept_before > timing::kShortestSleep) time = push_woken();
            push(ReadQueue::Kind::rx, time, input);
            last_byte = now;
            while (const auto event = decoder.next(input)) {
                const auto* frame = std::get_if<wire::BurstFrame>(&*event);
                if (frame == nullptr) continue;
                if (options_.settings.layout.has_count() && watch.is_altered(frame->values().count))
                    return End::altered;
                known_->count = frame->values().count;
                known_->arrival = time;
                last_frame = now;
                failures_in_a_row_ = 0;
                has_frames_ = true;
            }
        }
        if (now - last_byte > silence) return End::stalled;
        if (now - last_frame > std::max(babble, silence)) return End::unframed;
    }
    return End::stopped;
}

// A full queue holds the reader up: what the kernel cannot keep meanwhile is lost on a real port,
// seen as a gap and counted here; the writer of a pseudo-terminal is held up in turn.
void SensorLink::push(ReadQueue::Kind kind, RawTime time, std::span<const std::byte> bytes) {
    while (!queue_.push(kind, time, bytes)) {
        if (stop_) return;
        hold_up();
    }
    is_held_up_ = false;
}

/// After a sleep of the host, before the first bytes that follow it.  @return  when they came, by
/// a clock that tells of the sleep: the journal may be written much later, after another sleep.
RawTime SensorLink::push_woken() {
    const timing::ClockReading reading = clock_.read();
    while (!queue_.push_woken(reading) && !stop_) hold_up();
    is_held_up_ = false;
    return reading.raw;
}

void SensorLink::hold_up() {
    ++queue_full_;
    is_held_up_ = true;
    std::this_thread::sleep_for(kQueueRetry);
}

void SensorLink::stop_sensor() {
    if (!port_) return;
    const bool is_recorded = status().state == LinkStatus::State::sampling;
    for (const auto& command : wire::stop_sampling()) {
        const RawTime sent = clock_.raw();
        if (!port_->write(command)) return;
        if (is_recorded) push(ReadQueue::Kind::tx, sent, command);
        std::this_thread::sleep_for(wire::kCommandSpacing);
    }
    if (!is_recorded) return;

    // Frames that are on their way belong to the session.
    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    const auto end = steady_clock::now() + kLongestDrain;
    while (steady_clock::now() < end) {
        const auto count = port_->read(bytes, kSilence);
        if (count.value_or(0) == 0) return;
        push(ReadQueue::Kind::rx, clock_.raw(), std::span(bytes).first(*count));
    }
}

}  // namespace a351::daemon
