#pragma once
/// @file
/// The line from the device to the host's terminal: keeps what was sent, in order, until the host
/// may see it and the terminal has taken it, and what became of every frame.  No I/O and no clock.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sim/device/line_device.hpp"
#include "sim/line/transport.hpp"

namespace a351::sim {

/// Counts of frames as they were settled: handed over or lost.
struct LineReport {
    struct Run {
        std::int64_t first_index = 0;  ///< On the source's grid.
        std::int64_t frames = 0;
    };
    std::int64_t frames_made = 0;       ///< By the device; a second copy is none.
    std::int64_t frames_sent = 0;       ///< Arrived whole, second copies included.
    std::int64_t frames_damaged = 0;    ///< Arrived, but of no use.
    std::int64_t frames_lost = 0;       ///< Nothing of them arrived, for whatever reason ...
    std::int64_t lost_by_overrun = 0;   ///< ... the terminal was full,
    std::int64_t lost_unplugged = 0;    ///< ... nothing was plugged in.
    std::int64_t frames_pending = 0;    ///< Nothing of them had arrived at the end.
    std::int64_t frames_repeated = 0;   ///< Of those sent.
    std::int64_t frames_misplaced = 0;  ///< Of those sent.
    std::int64_t frames_flagged = 0;    ///< Of those sent: EA, ALIASI_ERR or an alarm in FLAG.
    std::int64_t bytes_handed_over = 0;
    std::int64_t bytes_of_answers = 0;  ///< Of those handed over.
    std::int64_t bytes_of_frames = 0;   ///< Of those handed over: in frames that arrived whole.
    std::vector<Run> runs;              ///< One per stay in sampling mode, of frames sent.
    Nanoseconds largest_lateness{0};    ///< Simulated time from when it might to when it was sent.
    /// Largest least lateness of 50 frames: no receiver can tell that much from a delay of the line.
    Nanoseconds steady_lateness{0};
    std::int64_t frames_late = 0;  ///< Sent more than 1 ms (simulated) after they might.
};

class Line final : public LineSink {
public:
    /// Called for every frame once its last byte has gone or was lost.
    using SettledHandler = std::function<void(const TruthRecord&)>;

    /// @param start  no byte is sent before it.
    Line(const LineParameters& parameters, std::uint64_t seed, UtcTime start,
         SettledHandler on_settled);

    void send(std::span<const std::byte> bytes, UtcTime leaves, const TruthRecord* frame) override;

    /// Bytes that no device made.
    void send_garbage(std::span<const std::byte> bytes, UtcTime leaves);

    static constexpr std::size_t kMostPending = 16384;
    [[nodiscard]] bool is_full() const override { return pending_size() >= kMostPending; }

    /// How long before its last byte leaves the device a frame must be sent here: bytes that take
    /// their time on the wire are seen one by one.
    [[nodiscard]] Nanoseconds lead() const;

    /// Bytes that the host may see by now, in order; one at a time if they come bytewise.
    [[nodiscard]] std::span<const std::byte> shown(UtcTime now) const;

    /// When the host may see more than it has taken.
    [[nodiscard]] std::optional<UtcTime> next_shown() const { return transport_.next_shown(); }

    [[nodiscard]] bool is_empty() const noexcept { return pending_size() == 0; }

    /// The terminal took the first `byte_count` bytes shown.
    void handed_over(std::size_t byte_count, UtcTime simulated);

    /// The first `byte_count` bytes found the terminal full and are lost.
    void overrun(std::size_t byte_count, UtcTime simulated);

    /// Nothing more is shown before `end`.
    void hold_until(UtcTime end) { transport_.hold_until(end); }

    /// Speeds of the device and of the host's terminal.  Where they differ, what is sent from now on
    /// arrives as other bytes.
    void set_speeds(int device_baud, int host_baud) noexcept;

    /// What is under way and all that is sent until plug_in() is lost.
    void unplug(UtcTime simulated);

    /// The end: what is still under way will never arrive.
    void abandon(UtcTime simulated) { remove(pending_size(), Way::abandoned, simulated); }
    void plug_in() noexcept { is_plugged_in_ = true; }

    [[nodiscard]] const LineReport& report() const noexcept { return report_; }

private:
    enum class Content { answer, frame, garbage };

    /// In which bytes leave the line.
    enum class Way { handed_over, overrun, unplugged, abandoned };

    /// Bytes that were sent together, by their place in the whole stream.
    struct Mark {
        std::uint64_t begin = 0, end = 0;
        std::uint64_t bytes_lost = 0;
        Content content = Content::answer;
        TruthRecord truth{};
    };
    [[nodiscard]] std::size_t pending_size() const noexcept { return queue_.size() - queue_start_; }
    void put(std::span<const std::byte> bytes, UtcTime leaves, Mark mark);
    void carry(std::size_t byte_count, UtcTime leaves);
    void remove(std::size_t byte_count, Way way, UtcTime simulated);
    void settle(Mark& mark, Way way, UtcTime simulated, UtcTime shown);
    void count_lost(Way way);
    void count_sent(const TruthRecord& truth, Nanoseconds lateness);

    LineParameters parameters_;
    Transport transport_;
    SettledHandler on_settled_;
    int device_baud_ = 0, host_baud_ = 0;  ///< Both 0: equal.
    bool is_plugged_in_ = true;
    std::vector<std::byte> queue_;
    std::size_t queue_start_ = 0;  ///< Bytes before it are gone.
    std::uint64_t gone_ = 0;       ///< Of the whole stream: handed over or lost.
    std::vector<Mark> marks_;
    std::size_t marks_start_ = 0;  ///< Those before it are settled.
    int last_run_ = 0;
    Nanoseconds least_lateness_ = Nanoseconds::max();  ///< Of the frames since the last 50.
    std::optional<UtcTime> last_frame_;                ///< Instant of the last one sent here.
    LineReport report_;
};

}  // namespace a351::sim
