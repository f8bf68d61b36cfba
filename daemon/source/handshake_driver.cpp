#include "daemon/source/handshake_driver.hpp"

#include <algorithm>
#include <array>
#include <thread>

namespace a351::daemon {
namespace {

using std::chrono::ceil;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

milliseconds time_left(steady_clock::time_point end) {
    return std::max(milliseconds(0), ceil<milliseconds>(end - steady_clock::now()));
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

bool drain(Port& port, const wire::DrainUntilSilent& step, std::size_t& passed_over) {
    const auto end = steady_clock::now() + step.limit;
    std::array<std::byte, 4096> discarded{};
    while (steady_clock::now() < end) {
        const auto came = port.read(discarded, std::min(step.quiet, time_left(end)));
        if (!came) return false;
        if (*came == 0) break;
        passed_over += *came;
    }
    return true;
}

}  // namespace

HandshakeRun run_handshake(wire::Handshake& handshake, Port& port, const HostClock& clock,
                           const std::atomic<bool>& stop) {
    HandshakeRun run;
    std::vector<std::byte> answer;
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
        } else if (const auto* silence = std::get_if<wire::DrainUntilSilent>(&step)) {
            is_there = drain(port, *silence, run.bytes_skipped);
        } else if (auto* sampling = std::get_if<wire::Sampling>(&step)) {
            run.outcome = std::move(sampling->identity);
            return run;
        } else if (auto* failure = std::get_if<wire::HandshakeFailure>(&step)) {
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

}  // namespace a351::daemon
