#include "sim/line/line.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace a351::sim::line {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kLineBitsPerByte = 10;
constexpr int kUsualBaud = 460800;
constexpr Nanoseconds kPunctual = 1ms;
constexpr std::int64_t kFewFrames = 50;  // Half the frames that set a receiver's clock at 50 Hz.

Nanoseconds wire_time(std::size_t bytes, int baud) {
    return Nanoseconds(1s) * static_cast<std::int64_t>(bytes) * kLineBitsPerByte / baud;
}

constexpr double kBitsPerByte = 10.0;  ///< Start bit, eight bits from the lowest on, stop bit.

/// Returns the level of the line; the time is in bits of the sender.  The idle line is high.
bool level(std::span<const std::byte> bytes, double bit) {
    const auto index = static_cast<std::size_t>(bit / kBitsPerByte);
    if (bit < 0.0 || index >= bytes.size()) return true;
    const int within = static_cast<int>(bit) - 10 * static_cast<int>(index);
    if (within == 0) return false;
    if (within == 9) return true;
    return ((std::to_integer<unsigned>(bytes[index]) >> (within - 1)) & 1U) != 0;
}

}  // namespace

std::vector<std::byte> received_at_baud(std::span<const std::byte> bytes, int sent_baud,
                                        int received_baud) {
    // In bits of the sender: length of a receiver's bit, end of the bytes, present position, which
    // is the start of a bit or the end of a stop bit within it.
    const double ratio = static_cast<double>(sent_baud) / received_baud;
    const double end = kBitsPerByte * static_cast<double>(bytes.size());
    std::vector<std::byte> heard;
    double at = 0.0;
    while (at < end) {
        if (level(bytes, at)) {
            at = std::floor(at) + 1.0;
            continue;
        }
        unsigned value = 0;
        for (int bit = 0; bit < 8; ++bit) {
            if (level(bytes, at + (bit + 1.5) * ratio)) value |= 1U << bit;
        }
        heard.push_back(static_cast<std::byte>(value));
        at += 9.5 * ratio;
    }
    return heard;
}

Line::Line(const scenario::LineParameters& parameters, std::uint64_t seed, UtcTime start,
           SettledHandler on_settled)
    : parameters_(parameters),
      transport_(parameters, seed, start),
      on_settled_(std::move(on_settled)) {}

Nanoseconds Line::lead() const {
    if (!parameters_.is_paced) return Nanoseconds(0);
    return wire_time(wire::kLargestFrame, device_baud_ > 0 ? device_baud_ : kUsualBaud);
}

void Line::set_speeds(int device_baud, int host_baud) noexcept {
    device_baud_ = device_baud;
    host_baud_ = host_baud;
}

void Line::send(std::span<const std::byte> bytes, UtcTime leaves, const truth::Record* frame) {
    Mark mark;
    if (frame != nullptr) {
        mark.content = Content::frame;
        mark.truth = *frame;
        if (frame->utc != last_frame_) ++report_.frames_made;
        last_frame_ = frame->utc;
    }
    put(bytes, leaves, mark);
}

void Line::send_garbage(std::span<const std::byte> bytes, UtcTime leaves) {
    Mark mark;
    mark.content = Content::garbage;
    put(bytes, leaves, mark);
}

void Line::put(std::span<const std::byte> bytes, UtcTime leaves, Mark mark) {
    mark.begin = gone_ + pending_size();
    if (device_baud_ == host_baud_) {
        queue_.insert(queue_.end(), bytes.begin(), bytes.end());
    } else if (!bytes.empty()) {
        std::vector<std::byte> heard;
        if (host_baud_ > 0) heard = received_at_baud(bytes, device_baud_, host_baud_);
        queue_.insert(queue_.end(), heard.begin(), heard.end());
        mark.truth.fate = heard.empty() ? truth::Fate::lost : truth::Fate::damaged;
    }
    mark.end = gone_ + pending_size();
    marks_.push_back(mark);
    carry(static_cast<std::size_t>(mark.end - mark.begin), leaves);
    if (!is_plugged_in_) return unplug(leaves);
    // A frame without bytes is settled together with the bytes sent before it.
    if (is_empty()) remove(0, Way::handed_over, leaves);
}

void Line::carry(std::size_t byte_count, UtcTime leaves) {
    if (!parameters_.is_paced) return transport_.carry(byte_count, leaves);
    const int baud = device_baud_ > 0 ? device_baud_ : kUsualBaud;
    for (std::size_t left = byte_count; left > 0; --left)
        transport_.carry(1, leaves - wire_time(left - 1, baud));
}

std::span<const std::byte> Line::shown(UtcTime now) const {
    std::size_t size = transport_.shown(now);
    if (parameters_.is_bytewise) size = std::min<std::size_t>(size, 1);
    return std::span(queue_).subspan(queue_start_, size);
}

void Line::handed_over(std::size_t byte_count, UtcTime simulated) {
    report_.bytes_handed_over += static_cast<std::int64_t>(byte_count);
    remove(byte_count, Way::handed_over, simulated);
}

void Line::overrun(std::size_t byte_count, UtcTime simulated) {
    remove(byte_count, Way::overrun, simulated);
}

void Line::unplug(UtcTime simulated) {
    is_plugged_in_ = false;
    remove(pending_size(), Way::unplugged, simulated);
}

std::vector<std::byte> Line::take_back() {
    const std::vector<std::byte> pending(queue_.begin() + static_cast<std::ptrdiff_t>(queue_start_),
                                         queue_.end());
    transport_.take(pending.size());
    queue_.clear();
    queue_start_ = 0;
    gone_ += pending.size();
    marks_.clear();
    return pending;
}

void Line::remove(std::size_t byte_count, Way way, UtcTime simulated) {
    const std::uint64_t end = gone_ + byte_count;
    while (!marks_.empty() && marks_.front().begin <= end) {
        Mark& front = marks_.front();
        if (way != Way::handed_over)
            front.bytes_lost += std::min(front.end, end) - std::max(front.begin, gone_);
        if (front.end > end) break;
        Mark mark = front;
        marks_.pop_front();
        const auto size = static_cast<std::size_t>(mark.end - gone_);
        const UtcTime shown = size > 0 ? transport_.shown_at(size) : simulated;
        pass(size);
        settle(mark, way, simulated, shown);
    }
    pass(static_cast<std::size_t>(end - gone_));
    if (2 * queue_start_ < queue_.size()) return;
    queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(queue_start_));
    queue_start_ = 0;
}

/// Removes the first `byte_count` bytes from the queue.
void Line::pass(std::size_t byte_count) {
    transport_.take(byte_count);
    queue_start_ += byte_count;
    gone_ += byte_count;
}

void Line::settle(Mark& mark, Way way, UtcTime simulated, UtcTime shown) {
    const auto arrived = static_cast<std::int64_t>(mark.end - mark.begin - mark.bytes_lost);
    if (mark.content == Content::answer) report_.bytes_of_answers += arrived;
    if (mark.content != Content::frame) return;
    truth::Fate& fate = mark.truth.fate;
    if (fate == truth::Fate::lost) {  // Lost on purpose, before it came here.
        ++report_.frames_lost;
    } else if (mark.bytes_lost > 0 && arrived == 0) {
        fate = truth::Fate::lost;
        if (way == Way::abandoned) {
            ++report_.frames_pending;
        } else {
            ++report_.frames_lost;
            ++(way == Way::overrun ? report_.lost_by_overrun : report_.lost_unplugged);
        }
    } else if (mark.bytes_lost > 0 || fate == truth::Fate::damaged) {
        fate = truth::Fate::damaged;
        ++report_.frames_damaged;
    } else {
        report_.bytes_of_frames += arrived;
        count_sent(mark.truth, simulated - shown);
    }
    on_settled_(mark.truth);
}

void Line::count_sent(const truth::Record& truth, Nanoseconds lateness) {
    if (truth.sampling_run != last_run_) {
        last_run_ = truth.sampling_run;
        report_.runs.push_back({truth.grid_index, 0});
    }
    ++report_.runs.back().frames;
    ++report_.frames_sent;
    if (truth.fate == truth::Fate::repeated) ++report_.frames_repeated;
    if (truth.fate == truth::Fate::misplaced) ++report_.frames_misplaced;
    constexpr unsigned kTroubles = wire::kFlagError | wire::kFlagAliasing | wire::kFlagAlarms;
    if ((truth.values.flag & kTroubles) != 0) ++report_.frames_flagged;
    report_.largest_lateness = std::max(report_.largest_lateness, lateness);
    least_lateness_ = std::min(least_lateness_, lateness);
    if (report_.frames_sent % kFewFrames == 0) {
        report_.steady_lateness =
            std::max(report_.steady_lateness, std::exchange(least_lateness_, Nanoseconds::max()));
    }
    if (lateness > kPunctual) ++report_.frames_late;
}

}  // namespace a351::sim::line
