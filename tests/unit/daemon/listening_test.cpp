// The known stream, listened for on a port whose bytes are fixed, so that no real sensor or time
// decides.
#include <algorithm>
#include <span>
#include <vector>
#include "daemon/source/sampling_start.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::source;

namespace {

constexpr int kCountStep = 80;                 // at 50 samples/s
constexpr int kKnownCount = 400 * kCountStep;  // eight seconds after a start

/// Returns frames whose counters follow `count`.
std::vector<std::byte> frames_after(int count, int frames) {
    std::vector<std::byte> bytes;
    for (int i = 1; i <= frames; ++i) {
        wire::BurstValues values;
        values.count = static_cast<std::uint16_t>(count + i * kCountStep);
        wire::append_frame(wire::BurstLayout::recommended(), values, bytes);
    }
    return bytes;
}

/// A port that gives its bytes in reads of seven, less than a frame, and is then gone.
class ScriptedPort : public Port {
public:
    explicit ScriptedPort(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    std::optional<std::size_t> read(std::span<std::byte> into, std::chrono::milliseconds) override {
        const std::size_t count = std::min<std::size_t>({7, into.size(), bytes_.size() - at_});
        if (count == 0) return std::nullopt;
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), count, into.begin());
        at_ += count;
        return count;
    }
    bool write(std::span<const std::byte>) override { return false; }
    [[nodiscard]] const std::string& description() const noexcept override { return description_; }

private:
    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
    std::string description_;
};

/// Listens for a stream whose last frame had kKnownCount and has just arrived.
/// @param heard  bytes that were read before.
Listening::Outcome outcome_of(std::vector<std::byte> heard, std::vector<std::byte> bytes) {
    const HostClock clock;
    journal::StreamEnd known{{}, kKnownCount, clock.raw()};
    known.header.profile = "A351";
    known.header.output_rate_hz = 50;
    known.header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
    ScriptedPort port(std::move(bytes));
    const std::atomic<bool> stop{false};
    std::vector<Read> reads;
    if (!heard.empty()) reads.push_back({clock.raw(), std::move(heard)});
    return listen_for(known, std::move(reads), port, clock, stop).outcome;
}

std::vector<std::byte> joined(std::vector<std::byte> first, const std::vector<std::byte>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace

TEST_CASE("a stream that continues is known, however its frames are cut") {
    CHECK(outcome_of({}, frames_after(kKnownCount, 20)) == Listening::Outcome::continues);
    CHECK(
        outcome_of(frames_after(kKnownCount, 5), frames_after(kKnownCount + 5 * kCountStep, 15)) ==
        Listening::Outcome::continues);
}

TEST_CASE("a sensor that restarts while it is listened to is not the known stream") {
    // Nine frames are one less than make the stream certain.
    const int frames_before = GENERATE(1, 5, 9);
    const auto known = frames_after(kKnownCount, frames_before);
    const auto restarted = frames_after(0, 20);
    SECTION("between two frames") {
        CHECK(outcome_of({}, joined(known, restarted)) == Listening::Outcome::not_known);
    }
    SECTION("in the middle of a frame") {
        const auto cut = std::vector<std::byte>(known.begin(), known.end() - 5);
        CHECK(outcome_of({}, joined(cut, restarted)) == Listening::Outcome::not_known);
    }
    SECTION("after the bytes that were read before") {
        CHECK(outcome_of(known, restarted) == Listening::Outcome::not_known);
    }
}
