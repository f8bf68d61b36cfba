#pragma once
/// @file
/// A host for tests of the replay: configures the device by the handshake, then receives bytes.

#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/wire/handshake.hpp"
#include "sim/replay/replay_device.hpp"

namespace a351::sim::replay {

/// A line that keeps the bytes of a device, piece by piece.
class SentPieces final : public device::LineSink {
public:
    struct Piece {
        std::vector<std::byte> bytes;
        UtcTime leaves;
    };

    void send(std::span<const std::byte> bytes, UtcTime leaves, const truth::Record*) override {
        pieces.push_back({{bytes.begin(), bytes.end()}, leaves});
    }
    [[nodiscard]] bool is_full() const override { return pieces.size() >= capacity; }
    [[nodiscard]] std::vector<std::byte> take_back() override {
        SentPieces unseen;
        for (; pieces.size() > seen; pieces.pop_back())
            unseen.pieces.insert(unseen.pieces.begin(), pieces.back());
        return unseen.bytes();
    }

    [[nodiscard]] std::vector<std::byte> bytes() const {
        std::vector<std::byte> all;
        for (const Piece& piece : pieces) {
            all.insert(all.end(), piece.bytes.begin(), piece.bytes.end());
        }
        return all;
    }

    std::vector<Piece> pieces;
    std::size_t capacity = SIZE_MAX;
    std::size_t seen = SIZE_MAX;  ///< Pieces that have reached the host.
};

/// A host whose clocks move only in the test's calls.  Simulated time begins at `now`.
class ReplayHost {
public:
    ReplayHost(Device& device, UtcTime now) : device_(device) { now_.simulated = now; }

    /// Runs the daemon's handshake without waiting.  @throws std::runtime_error  if it fails
    wire::DeviceIdentity configure(const wire::SensorSettings& settings = {},
                                   const char* profile = "A351") {
        wire::Handshake handshake(*wire::find_profile(profile), settings);
        std::vector<std::byte> answer;
        while (true) {
            const wire::HandshakeStep step = handshake.next(answer);
            answer.clear();
            if (const auto* transmit = std::get_if<wire::Transmit>(&step)) {
                send(transmit->bytes);
                now_.steady += transmit->pause_after;
            } else if (const auto* wanted = std::get_if<wire::Receive>(&step)) {
                answer = line.bytes();
                if (answer.size() > wanted->byte_count) answer.resize(wanted->byte_count);
                line.pieces.clear();
            } else if (const auto* drain = std::get_if<wire::DrainUntilSilent>(&step)) {
                now_.steady += drain->quiet;
                line.pieces.clear();
            } else if (const auto* failure = std::get_if<wire::HandshakeFailure>(&step)) {
                throw std::runtime_error(failure->reason);
            } else {
                return std::get<wire::Sampling>(step).identity;
            }
        }
    }

    void stop() {
        for (const auto& command : wire::stop_sampling()) send(command);
    }

    void send(std::span<const std::byte> bytes) { device_.receive(bytes, now_, line); }

    /// Lets time pass.
    void wait_until(UtcTime time) {
        now_.simulated = time;
        device_.advance_to(now_, line);
    }
    void wait(Nanoseconds duration) { wait_until(now_.simulated + duration); }

    /// Receives piece after piece until the session is over, that is, nothing is due for an hour.
    void listen() {
        wait(Nanoseconds(0));
        while (const auto due = device_.next_due()) {
            if (*due - now_.simulated >= std::chrono::hours(1)) return;
            wait_until(std::max(*due, now_.simulated));
        }
    }

    [[nodiscard]] UtcTime now() const { return now_.simulated; }

    SentPieces line;

private:
    Device& device_;
    device::Instant now_;
};

}  // namespace a351::sim::replay
