#include "daemon/source/sampling_start.hpp"

#include <algorithm>
#include <array>
#include <thread>

#include "daemon/source/read_queue.hpp"
#include "protocol/timing/sample_index.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::source {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kFramesInStep = 10;
// Longest silence, real time.  A busy host pauses this long; adapters and frames have shorter
// periods.
constexpr milliseconds kLongestSilence{500};
constexpr int kSilentFrames = 20;
// Longest time of bytes without frames, instrument time: beyond it baud rate or layout differ.
constexpr std::chrono::seconds kLongestBabble{3};

/// Checks that frames continue a known stream, each one counter step after the one before.
class Continuation {
public:
    Continuation(const journal::StreamEnd& known, std::uint16_t count_step)
        : known_(known), count_step_(count_step) {}

    void take(std::uint16_t count, RawTime arrival) {
        const bool is_in_step =
            frames_in_step_ > 0 && static_cast<std::uint16_t>(count - last_.count) == count_step_;
        frames_in_step_ = is_in_step ? frames_in_step_ + 1 : 1;
        if (!is_in_step) first_ = {count, arrival};
        last_ = {count, arrival};
    }
    [[nodiscard]] bool is_certain() const { return frames_in_step_ >= kFramesInStep; }

    /// Checks the first and the last frame.  If the port stored the frames, the first one continues
    /// the known counter.  If the last one came without delay, its counter agrees with the elapsed
    /// time.
    [[nodiscard]] bool fits() const { return fits(first_) || fits(last_); }

private:
    struct Frame {
        std::uint16_t count = 0;
        RawTime arrival;
    };
    [[nodiscard]] bool fits(const Frame& frame) const {
        using Kind = timing::Placement::Kind;
        timing::SampleIndex index(count_step_, Hertz(known_.header.output_rate_hz));
        static_cast<void>(index.place(known_.count, false, known_.arrival));
        const Kind kind = index.place(frame.count, false, frame.arrival).kind;
        return kind == Kind::next || kind == Kind::after_gap;
    }

    const journal::StreamEnd& known_;
    std::uint16_t count_step_;
    int frames_in_step_ = 0;
    Frame first_, last_;  ///< First and last frame of the run that is in step.
};

milliseconds time_left(steady_clock::time_point end) {
    return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(end - steady_clock::now()));
}

/// Reads one answer, or as much of it as arrives in time.  @return false if the port is gone.
bool receive(Port& port, const wire::Receive& step, std::vector<std::byte>& answer) {
    const auto end = steady_clock::now() + step.timeout;
    answer.resize(step.byte_count);
    std::size_t count = 0;
    while (count < answer.size()) {
        const milliseconds left = time_left(end);
        const auto came = port.read(std::span(answer).subspan(count), left);
        if (!came) return false;
        count += *came;
        if (left == milliseconds(0)) break;
    }
    answer.resize(count);
    return true;
}

bool drain(Port& port, const wire::DrainUntilSilent& step, std::size_t& skipped) {
    const auto end = steady_clock::now() + step.limit;
    std::array<std::byte, 4096> discarded{};
    while (steady_clock::now() < end) {
        const auto came = port.read(discarded, std::min(step.quiet, time_left(end)));
        if (!came) return false;
        if (*came == 0) break;
        skipped += *came;
    }
    return true;
}

}  // namespace

Listening listen_for(const journal::StreamEnd& known, std::vector<Read> heard, Port& port,
                     const HostClock& clock, const std::atomic<bool>& stop) {
    const journal::Header& header = known.header;
    const int rate_hz = header.output_rate_hz;
    const auto step = wire::find_profile(header.profile)->count_step(rate_hz);
    wire::BurstDecoder decoder(*wire::BurstLayout::from_burst_ctrl(header.burst_ctrl), step);
    Continuation continuation(known, step);

    const auto real = [&](Nanoseconds span) { return clock.real_span(span); };
    const auto silence =
        std::max<Nanoseconds>(kLongestSilence, real(from_seconds(1.0 * kSilentFrames / rate_hz)));
    const auto babble = silence + std::max<Nanoseconds>(silence, real(kLongestBabble));
    const auto begin = steady_clock::now();
    auto last_byte = begin;

    Listening listening;
    const auto take = [&](Read read) {
        std::span<const std::byte> input = read.bytes;
        while (const auto event = decoder.next(input))
            if (const auto* frame = std::get_if<wire::BurstFrame>(&*event))
                continuation.take(frame->values().count, read.time);
        listening.reads.push_back(std::move(read));
    };
    for (Read& read : heard) take(std::move(read));
    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    while (!stop && steady_clock::now() - begin < babble) {
        const auto came = port.read(bytes, std::chrono::ceil<milliseconds>(kLongestSilence / 10));
        const RawTime time = clock.raw();
        if (!came) {
            listening.outcome = Listening::Outcome::port_gone;
            break;
        }
        if (*came == 0) {
            if (steady_clock::now() - last_byte > silence) break;
            continue;
        }
        last_byte = steady_clock::now();
        const auto input = std::span(bytes).first(*came);
        take({time, {input.begin(), input.end()}});
        if (!continuation.is_certain()) continue;
        if (continuation.fits()) listening.outcome = Listening::Outcome::continues;
        break;
    }
    return listening;
}

Probe probe_silent_line(Port& port, const HostClock& clock, const std::atomic<bool>& stop) {
    constexpr int kTries = 3;
    Probe probe;
    for (int i = 0; i < kTries && !stop; ++i) {
        std::vector<wire::Command> commands = wire::read_mode();
        bool is_there = port.write(std::array{wire::kEndByte});  // completes a half-sent command
        for (const wire::Command& command : commands) {
            std::this_thread::sleep_for(wire::kCommandSpacing);
            is_there = is_there && port.write(command);
        }
        std::vector<std::byte> answer;
        is_there = is_there && receive(port, {.byte_count = wire::kAnswerSize}, answer);
        if (!is_there) return {Probe::Outcome::port_gone, {}};
        if (answer.empty()) continue;
        const auto mode = wire::parse_answer(wire::kModeCtrl, answer);
        if (mode && wire::ConfigMode::from_mode_ctrl(*mode)) return {Probe::Outcome::stopped, {}};
        probe.outcome = Probe::Outcome::heard;
        probe.reads.push_back({clock.raw(), std::move(answer)});
        return probe;
    }
    return probe;
}

HandshakeRun run_handshake(wire::Handshake& handshake, Port& port, const HostClock& clock,
                           const std::atomic<bool>& stop) {
    HandshakeRun run;
    std::vector<std::byte> answer;
    std::size_t received = 0;
    while (!stop) {
        wire::HandshakeStep step = handshake.next(answer);
        answer.clear();
        bool is_there = true;
        if (auto* transmit = std::get_if<wire::Transmit>(&step)) {
            is_there = port.write(transmit->bytes);
            run.sent.push_back({clock.raw(), std::move(transmit->bytes)});
            std::this_thread::sleep_for(transmit->pause_after);
        } else if (const auto* wanted = std::get_if<wire::Receive>(&step)) {
            is_there = receive(port, *wanted, answer);
            received += answer.size();
        } else if (const auto* silence = std::get_if<wire::DrainUntilSilent>(&step)) {
            is_there = drain(port, *silence, run.bytes_skipped);
        } else if (auto* sampling = std::get_if<wire::Sampling>(&step)) {
            run.outcome = std::move(sampling->identity);
            return run;
        } else if (auto* failure = std::get_if<wire::HandshakeFailure>(&step)) {
            if (failure->is_unanswered) run.bytes_skipped += received;
            run.outcome = std::move(*failure);
            return run;
        }
        if (!is_there) {
            run.outcome = PortGone{};
            return run;
        }
    }
    run.outcome = wire::HandshakeFailure{"stopped"};
    return run;
}

}  // namespace a351::daemon::source
