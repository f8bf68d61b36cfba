#pragma once
/// @file
/// The line from the device to the host's terminal.  It keeps sent bytes in order until the host
/// may see them and the terminal has taken them, and records the fate of every frame.  No I/O and
/// no clock.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sim/device/line_device.hpp"
#include "sim/line/transport.hpp"

namespace a351::sim::line {

/// Returns the bytes that a UART set to `received_baud` receives when `bytes` are sent without a pause
/// at `sent_baud`, 8N1, with an idle line before and after.  The UART waits for a falling edge and
/// samples the bits in their middle.  Bytes without a stop bit are kept, as in a terminal without
/// PARMRK.  At equal speeds the bytes are unchanged.
[[nodiscard]] std::vector<std::byte> received_at_baud(std::span<const std::byte> bytes,
                                                      int sent_baud, int received_baud);

/// Counts of frames whose fate is settled: handed over or lost.
struct Report {
    struct Run {
        std::int64_t first_index = 0;  ///< Index on the source's grid.
        std::int64_t frames = 0;
    };
    std::int64_t frames_made = 0;       ///< Made by the device, without second copies.
    std::int64_t frames_sent = 0;       ///< Arrived whole, including second copies.
    std::int64_t frames_damaged = 0;    ///< Arrived damaged.
    std::int64_t frames_lost = 0;       ///< No byte of them arrived, for any reason.
    std::int64_t lost_by_overrun = 0;   ///< Part of frames_lost: the terminal was full.
    std::int64_t lost_unplugged = 0;    ///< Part of frames_lost: the port was pulled out.
    std::int64_t frames_pending = 0;    ///< No byte of them had arrived at the end.
    std::int64_t frames_repeated = 0;   ///< In frames_sent: COUNT of the frame before.
    std::int64_t frames_misplaced = 0;  ///< In frames_sent: COUNT does not follow.
    std::int64_t frames_flagged = 0;    ///< Part of frames_sent: EA, ALIASI_ERR or alarm in FLAG.
    std::int64_t bytes_handed_over = 0;
    std::int64_t bytes_of_answers = 0;  ///< Part of bytes_handed_over.
    std::int64_t bytes_of_frames = 0;  ///< Part of bytes_handed_over: in frames that arrived whole.
    std::vector<Run> runs;             ///< Frames sent, one entry per run of sampling.
    Nanoseconds largest_lateness{0};   ///< Largest delay after the due time, simulated.
    /// Largest, over all blocks of 50 frames sent, of the least lateness in a block.  A receiver
    /// cannot distinguish it from a delay of the line.
    Nanoseconds steady_lateness{0};
    std::int64_t frames_late = 0;  ///< Sent more than 1 ms (simulated) after the due time.
};

class Line final : public device::LineSink {
public:
    /// Takes each frame once its last byte has been handed over or lost.
    using SettledHandler = std::function<void(const truth::Record&)>;

    /// @param start  start of the simulation; no byte is sent before it.
    Line(const scenario::LineParameters& parameters, std::uint64_t seed, UtcTime start,
         SettledHandler on_settled);

    void send(std::span<const std::byte> bytes, UtcTime leaves,
              const truth::Record* frame) override;

    /// Sends bytes that do not come from the device.
    void send_garbage(std::span<const std::byte> bytes, UtcTime leaves);

    static constexpr std::size_t kMostPending = 16384;
    [[nodiscard]] bool is_full() const override { return pending_size() >= kMostPending; }

    /// Returns how long before its last byte leaves the device a frame must be sent here.  With
    /// is_paced the host sees the first bytes of a frame before the last one.
    [[nodiscard]] Nanoseconds lead() const;

    /// Returns the bytes that the host may see by now, in order; with is_bytewise one at a time.
    [[nodiscard]] std::span<const std::byte> shown(UtcTime now) const;

    /// Returns when the host may see more bytes than it has taken.
    [[nodiscard]] std::optional<UtcTime> next_shown() const { return transport_.next_shown(); }

    [[nodiscard]] bool is_empty() const noexcept { return pending_size() == 0; }

    /// Removes the first `byte_count` bytes shown, which the terminal took.
    void handed_over(std::size_t byte_count, UtcTime simulated);

    /// Removes the first `byte_count` bytes, which are lost because the terminal was full.
    void overrun(std::size_t byte_count, UtcTime simulated);

    /// Shows nothing more before `end`.
    void hold_until(UtcTime end) { transport_.hold_until(end); }

    /// Sets the baud rates of the device and of the host's terminal.  If they differ, bytes sent
    /// from now on arrive as other bytes.
    void set_speeds(int device_baud, int host_baud) noexcept;

    /// Loses all bytes under way and all that are sent until plug_in().
    void unplug(UtcTime simulated);

    /// Ends the line: bytes still under way never arrive.
    void abandon(UtcTime simulated) { remove(pending_size(), Way::abandoned, simulated); }

    [[nodiscard]] std::vector<std::byte> take_back() override;

    void plug_in() noexcept { is_plugged_in_ = true; }

    [[nodiscard]] const Report& report() const noexcept { return report_; }

private:
    enum class Content { answer, frame, garbage };

    /// Ways in which bytes leave the line.
    enum class Way { handed_over, overrun, unplugged, abandoned };

    /// Bytes that were sent together; their places count from the start of the whole stream.
    struct Mark {
        std::uint64_t begin = 0, end = 0;
        std::uint64_t bytes_lost = 0;
        Content content = Content::answer;
        truth::Record truth{};
    };
    [[nodiscard]] std::size_t pending_size() const noexcept { return queue_.size() - queue_start_; }
    void put(std::span<const std::byte> bytes, UtcTime leaves, Mark mark);
    void carry(std::size_t byte_count, UtcTime leaves);
    void remove(std::size_t byte_count, Way way, UtcTime simulated);
    void pass(std::size_t byte_count);
    void settle(Mark& mark, Way way, UtcTime simulated, UtcTime shown);
    void count_sent(const truth::Record& truth, Nanoseconds lateness);

    scenario::LineParameters parameters_;
    Transport transport_;
    SettledHandler on_settled_;
    int device_baud_ = 0, host_baud_ = 0;  ///< Both 0: equal.
    bool is_plugged_in_ = true;
    std::vector<std::byte> queue_;
    std::size_t queue_start_ = 0;  ///< Bytes before it are gone.
    std::uint64_t gone_ = 0;       ///< Bytes of the whole stream that were handed over or lost.
    std::deque<Mark> marks_;       ///< Those that are not settled.
    int last_run_ = 0;
    Nanoseconds least_lateness_ = Nanoseconds::max();  ///< In the present block of 50 frames.
    std::optional<UtcTime> last_frame_;                ///< Instant of the last frame sent here.
    Report report_;
};

}  // namespace a351::sim::line
