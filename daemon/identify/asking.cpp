#include "daemon/identify/asking.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <span>
#include <thread>
#include <utility>

#include "daemon/source/sampling_start.hpp"
#include "protocol/wire/commands.hpp"

namespace a351::daemon::identify {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// Real time.  A GPS receiver sends its lines once a second.
constexpr milliseconds kListening{1200};
constexpr milliseconds kOneRead{100};
// Instrument time: with handshake and registers less than a minute.
constexpr seconds kReceiving{50};

/// Returns the baud rates of the profile, the configured one first.
std::vector<int> bauds_of(const source::LinkOptions& link) {
    std::vector<int> bauds{link.baud};
    for (const wire::Coded& coded : link.profile->baud_rates)
        if (coded.value != link.baud) bauds.push_back(coded.value);
    return bauds;
}

/// Receives for some real time.  @return false if the port is gone.
bool receive(source::Port& port, const source::HostClock& clock, Nanoseconds span,
             Observation& seen) {
    std::array<std::byte, 4096> buffer{};
    for (const auto end = steady_clock::now() + span; steady_clock::now() < end;) {
        const auto count = port.read(buffer, kOneRead);
        if (!count) return false;
        if (*count == 0) continue;
        seen.bytes.insert(seen.bytes.end(), buffer.begin(),
                          buffer.begin() + static_cast<std::ptrdiff_t>(*count));
        seen.reads.push_back({static_cast<std::uint32_t>(seen.bytes.size()), clock.raw()});
    }
    return true;
}

void listen(source::Port& port, const source::HostClock& clock, Observation& seen) {
    Observation heard;
    static_cast<void>(receive(port, clock, kListening, heard));
    heard.bytes.resize(std::min(heard.bytes.size(), kMostHeard));
    seen.heard.clear();
    for (const std::byte byte : heard.bytes) seen.heard.push_back(static_cast<char>(byte));
}

void stop_sampling(source::Port& port) {
    for (const wire::Command& command : wire::stop_sampling()) {
        if (!port.write(command)) return;
        std::this_thread::sleep_for(wire::kCommandSpacing);
    }
}

/// Configures the sensor and receives its frames.
void ask(const source::LinkOptions& link, source::Port& port, const source::HostClock& clock,
         Observation& seen) {
    const std::atomic<bool> stop{false};
    // An unknown result makes the handshake reset the sensor, which repeats its start-up test: an
    // earlier question may have cleared a failed one.
    wire::Handshake handshake(*link.profile, link.settings, {}, wire::StartUpTest::unknown);
    handshake.read_all_registers();
    const source::HandshakeRun run = source::run_handshake(handshake, port, clock, stop);
    seen.device = handshake.identity();
    seen.start_up_test = handshake.start_up_test();
    seen.registers = handshake.registers();
    seen.repeated_reads = handshake.repeated_reads();
    seen.has_answered = !seen.registers.empty();
    seen.trouble.clear();
    if (const auto* failure = std::get_if<wire::HandshakeFailure>(&run.outcome)) {
        seen.has_answered = !failure->is_unanswered;
        seen.trouble = failure->reason;
    } else if (std::holds_alternative<source::PortGone>(run.outcome) ||
               !receive(port, clock, clock.real_span(kReceiving), seen)) {
        seen.trouble = "the port is gone; plug the cable in again";
    }
    stop_sampling(port);
}

}  // namespace

bool is_text(const std::string& bytes) noexcept {
    constexpr std::size_t kFewest = 16;
    return bytes.size() >= kFewest && std::ranges::all_of(bytes, [](char c) {
               return (c >= ' ' && c <= '~') || c == '\r' || c == '\n' || c == '\t';
           });
}

Observation ask_sensor(const source::LinkOptions& link, const source::HostClock& clock) {
    Observation seen;
    for (const int baud : bauds_of(link)) {
        const std::unique_ptr<source::Port> port = link.open(link.address, baud);
        seen.port = port->description();
        seen.baud = baud;
        listen(*port, clock, seen);
        if (is_text(seen.heard)) break;
        ask(link, *port, clock, seen);
        if (seen.has_answered) break;
    }
    seen.time = clock.now();
    return seen;
}

}  // namespace a351::daemon::identify
