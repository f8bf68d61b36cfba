#pragma once
/// @file
/// The emulated sensor on the axis of simulated time: takes the scenario's samples at their
/// instants, hands them to the register machine and queues its bytes when they are due.  No I/O
/// and no clock.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/device/register_machine.hpp"
#include "sim/signal/sample_source.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim {

struct StreamReport {
    struct Run {
        std::int64_t first_index = 0;  ///< On the scenario's grid.
        std::int64_t frames = 0;
    };
    std::int64_t frames_sent = 0;
    std::vector<Run> runs;            ///< One per stay in sampling mode that sent a frame.
    Nanoseconds largest_lateness{0};  ///< Simulated time from due to handed over.
};

/// The grid of samples is fixed in simulated time.  A sample that falls due in sampling mode is
/// sent; outside it, the grid goes on unheard.  Output rates above the grid's hold each sample.
class DeviceStream {
public:
    /// Called for every frame once its last byte has gone.
    using SentHandler = std::function<void(const TruthRecord&)>;

    DeviceStream(SampleSource& source, RegisterMachine& machine, SentHandler on_sent);

    /// Queues the frames that are due at `simulated`, as long as less than kMostPending bytes wait.
    void advance_to(UtcTime simulated);
    static constexpr std::size_t kMostPending = 16384;

    /// Commands from the host; answers are queued behind the frames.  `now`: the machine's clock.
    void receive(std::span<const std::byte> bytes, Nanoseconds now);

    /// Bytes for the host, in order.
    [[nodiscard]] std::span<const std::byte> pending() const noexcept;

    /// The first `byte_count` pending bytes have been handed over at `simulated`.
    void handed_over(std::size_t byte_count, UtcTime simulated);

    /// When the next sample falls due; std::nullopt after the last.
    [[nodiscard]] std::optional<UtcTime> next_due() const;

    [[nodiscard]] bool is_finished() const { return !next_due() && pending().empty(); }

    [[nodiscard]] const StreamReport& report() const noexcept { return report_; }

private:
    struct Queued {
        std::uint64_t end = 0;  ///< Bytes of the whole stream up to its last one.
        UtcTime due;
        TruthRecord truth;
    };

    [[nodiscard]] int repeats() const;
    [[nodiscard]] UtcTime instant() const;

    SampleSource& source_;
    RegisterMachine& machine_;
    SentHandler on_sent_;
    std::optional<TimedSample> held_;  ///< Sample whose repeats are not all sent.
    int repeat_ = 0;                   ///< Next repeat of it.
    std::vector<std::byte> queue_;
    std::size_t queue_start_ = 0;  ///< Bytes before it have been handed over.
    std::uint64_t handed_over_ = 0;
    std::deque<Queued> frames_;
    int last_run_ = 0;
    StreamReport report_;
};

}  // namespace a351::sim
