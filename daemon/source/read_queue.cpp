#include "daemon/source/read_queue.hpp"

#include <cstring>
#include <type_traits>

#include "protocol/core/invariant.hpp"

namespace a351::daemon::source {

// An entry and its bytes are contiguous.  If they do not fit before the end of the ring, an entry
// of kind kWrap fills the rest.  All sizes are multiples of the size of an entry.

ReadQueue::ReadQueue(std::size_t capacity) : capacity_(capacity), ring_(new std::byte[capacity]) {
    require_invariant((capacity & (capacity - 1)) == 0 && capacity > 2 * kLargestItem,
                      "the queue of reads has a capacity that is a power of two");
}

std::size_t ReadQueue::room_for(std::size_t size) noexcept {
    constexpr std::size_t kStep = sizeof(Entry);
    return kStep + (size + kStep - 1) / kStep * kStep;
}

ReadQueue::Entry ReadQueue::entry_at(std::uint64_t position) const noexcept {
    Entry entry;
    std::memcpy(&entry, ring_.get() + (position & (capacity_ - 1)), sizeof entry);
    return entry;
}

void ReadQueue::put_entry(std::uint64_t position, const Entry& entry) noexcept {
    std::memcpy(ring_.get() + (position & (capacity_ - 1)), &entry, sizeof entry);
}

bool ReadQueue::push(Kind kind, RawTime time, std::span<const std::byte> bytes) noexcept {
    require_invariant(bytes.size() <= kLargestItem, "a read fits into an item of the queue");
    std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    const std::size_t to_end = capacity_ - (tail & (capacity_ - 1));
    const std::size_t needed = room_for(bytes.size());
    const bool wraps = needed > to_end;
    if (tail + needed + (wraps ? to_end : 0) - head > capacity_) return false;
    if (wraps) {
        put_entry(tail, {kWrap, 0, 0});
        tail += to_end;
    }
    put_entry(tail, {static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(bytes.size()),
                     time.time_since_epoch().count()});
    if (!bytes.empty()) {
        std::memcpy(ring_.get() + (tail & (capacity_ - 1)) + sizeof(Entry), bytes.data(),
                    bytes.size());
    }
    tail_.store(tail + needed, std::memory_order_release);
    return true;
}

bool ReadQueue::push_session(journal::Header header, RawTime time) {
    const std::lock_guard lock(sessions_mutex_);
    sessions_.push_back(std::move(header));
    if (push(Kind::session, time, {})) return true;
    sessions_.pop_back();
    return false;
}

bool ReadQueue::push_woken(const timing::ClockReading& reading) noexcept {
    return push(Kind::woken, reading.raw, std::as_bytes(std::span(&reading, 1)));
}

std::optional<ReadQueue::Item> ReadQueue::front() noexcept {
    std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return std::nullopt;
    Entry entry = entry_at(head);
    if (entry.kind == kWrap) {
        head += capacity_ - (head & (capacity_ - 1));
        head_.store(head, std::memory_order_release);
        entry = entry_at(head);
    }
    require_invariant(
        entry.size <= kLargestItem && entry.kind <= static_cast<std::uint32_t>(Kind::woken),
        "the queue of reads has whole items");
    const std::byte* const bytes = ring_.get() + (head & (capacity_ - 1)) + sizeof(Entry);
    return Item{
        static_cast<Kind>(entry.kind), RawTime(Nanoseconds(entry.raw_ns)), {bytes, entry.size}};
}

void ReadQueue::pop() noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    head_.store(head + room_for(entry_at(head).size), std::memory_order_release);
}

journal::Header ReadQueue::take_session() {
    const std::lock_guard lock(sessions_mutex_);
    journal::Header header = std::move(sessions_.front());
    sessions_.pop_front();
    return header;
}

timing::ClockReading ReadQueue::woken() noexcept {
    static_assert(std::is_trivially_copyable_v<timing::ClockReading>);
    timing::ClockReading reading;
    std::memcpy(&reading, front()->bytes.data(), sizeof reading);
    return reading;
}

std::size_t ReadQueue::fill() const noexcept {
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    return static_cast<std::size_t>(tail_.load(std::memory_order_acquire) - head);
}

}  // namespace a351::daemon::source
