/// @file
/// The sensor's link while the stream runs: bytes read from the port go into the queue.

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>
#include <utility>

#include "daemon/source/sensor_link.hpp"
#include "protocol/timing/host_clock_rules.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/commands.hpp"

namespace a351::daemon::source {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// Shortest stall, real time: a busy host pauses this long without a fault.
constexpr milliseconds kShortestRealStall{1000};
// Instrument time after which silence, or bytes without frames, are a stall.
constexpr seconds kSilenceIsStall{2};
constexpr seconds kBabbleIsStall{3};
// Waiting times, real time.
constexpr milliseconds kStopCheck{200};
constexpr milliseconds kQueueRetry{10};
constexpr milliseconds kSilence{50};
constexpr seconds kLongestDrain{1};

/// Detects that the sample counter advances by a constant step other than the expected one, which
/// means another output rate.
class StepWatch {
public:
    explicit StepWatch(std::uint16_t expected) : expected_(expected) {}

    /// Takes the next counter value.  @return true once the same wrong step was repeated
    /// kStepsToBelieve times.
    [[nodiscard]] bool is_altered(std::uint16_t count) {
        const auto step = static_cast<std::uint16_t>(count - std::exchange(last_count_, count));
        const bool continues = step == std::exchange(last_step_, step) && step != expected_;
        times_ = continues ? times_ + 1 : 0;
        return times_ >= kStepsToBelieve;
    }

private:
    // Repetitions of the step.  Fewer may be lost frames or a counter that is stuck for a while.
    static constexpr int kStepsToBelieve = 20;

    std::uint16_t expected_;
    std::uint16_t last_count_ = 0, last_step_ = 0;
    int times_ = 0;
};

}  // namespace

SensorLink::End SensorLink::read_stream() {
    const auto at_least_real = [this](Nanoseconds instrument_span) {
        return std::max<Nanoseconds>(kShortestRealStall, clock_.real_span(instrument_span));
    };
    const auto frame_period = from_seconds(1.0 / options_.settings.output_rate_hz);
    const auto silence = at_least_real(std::max<Nanoseconds>(kSilenceIsStall, 20 * frame_period));
    const auto babble = at_least_real(kBabbleIsStall);

    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    // This decoder only checks that frames arrive, and at which rate; the archive has its own.
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
                failures_in_a_row_ = strange_bytes_ = 0;
                has_frames_ = true;
            }
        }
        if (now - last_byte > silence) return End::stalled;
        if (now - last_frame > std::max(babble, silence)) return End::unframed;
    }
    return End::stopped;
}

/// Waits, but ends at the first byte after a silence, or at a valid frame on a line that is never
/// silent: the sensor is back.
void SensorLink::wait_for_bytes(Nanoseconds real) {
    const auto end = steady_clock::now() + real;
    wire::BurstDecoder decoder(options_.settings.layout,
                               options_.profile->count_step(options_.settings.output_rate_hz));
    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    for (auto now = steady_clock::now(); !stop_ && now < end; now = steady_clock::now()) {
        const auto left = std::chrono::ceil<milliseconds>(end - now);
        const auto count = port_->read(bytes, std::min(left, kStopCheck));
        const RawTime time = clock_.raw();
        if (!count) return lose_port();
        if (*count == 0) {
            is_silent_ = true;
            continue;
        }
        std::span<const std::byte> input = std::span(bytes).first(*count);
        Read read{time, {input.begin(), input.end()}};
        bool has_frame = false;
        while (const auto event = decoder.next(input))
            has_frame |= std::holds_alternative<wire::BurstFrame>(*event);
        if (is_silent_ || has_frame) {
            std::vector<Read> heard;
            heard.push_back(std::move(read));
            return expect_stream(std::move(heard));
        }
    }
}

// A full queue makes the reader wait.  On a real port, bytes that the kernel cannot store meanwhile
// are lost; this shows as a gap and the waits are counted.  On a pseudo-terminal the writer
// waits too.
void SensorLink::push(ReadQueue::Kind kind, RawTime time, std::span<const std::byte> bytes) {
    push_or_wait([&] { return queue_.push(kind, time, bytes); });
}

/// Queues a clock reading after a sleep of the host, before the first bytes that follow it.  It is
/// taken here because the journal may be written much later, after another sleep.
/// @return  the arrival time of these bytes.
RawTime SensorLink::push_woken() {
    const timing::ClockReading reading = clock_.read();
    push_or_wait([&] { return queue_.push_woken(reading); });
    return reading.raw;
}

void SensorLink::wait_for_journal() {
    ++queue_full_;
    waits_for_journal_ = true;
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

    // Frames that are still on the line belong to the session.
    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    const auto end = steady_clock::now() + kLongestDrain;
    while (steady_clock::now() < end) {
        const auto count = port_->read(bytes, kSilence);
        if (count.value_or(0) == 0) return;
        push(ReadQueue::Kind::rx, clock_.raw(), std::span(bytes).first(*count));
    }
}

}  // namespace a351::daemon::source
