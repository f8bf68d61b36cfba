#pragma once
/// @file
/// A queue from the reader thread to the journal thread: one producer, one consumer, fixed
/// capacity, no lock and no allocation for bytes.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon::source {

class ReadQueue {
public:
    enum class Kind : std::uint32_t {
        rx,       ///< Bytes that one read() returned.
        tx,       ///< Bytes that were sent.
        session,  ///< Everything after it belongs to a new session: take_session().
        woken,    ///< The host slept before the items that follow: push_woken().
    };
    struct Item {
        Kind kind = Kind::rx;
        RawTime time;
        std::span<const std::byte> bytes;  ///< Valid until pop().
    };

    /// Capacity in bytes.  One hour at 50 Hz is 180 000 reads of 24 bytes, 48 with their stamp:
    /// 8.7 MB, rounded up to the next power of two.  Memory that was never filled is not resident.
    static constexpr std::size_t kCapacity = std::size_t{16} << 20;
    static constexpr std::size_t kLargestItem = 4096;

    /// @param capacity  bytes, a power of two, > 2 kLargestItem.
    explicit ReadQueue(std::size_t capacity = kCapacity);

    // Producer.
    /// Appends an item.  @param bytes  at most kLargestItem.  @return false if there is no room.
    [[nodiscard]] bool push(Kind kind, RawTime time, std::span<const std::byte> bytes) noexcept;
    /// Appends a session header.  This allocates; sessions are rare.
    [[nodiscard]] bool push_session(journal::Header header, RawTime time);
    /// Appends a clock reading after a sleep of the host.
    /// @param reading  taken no later than the items that follow.
    [[nodiscard]] bool push_woken(const timing::ClockReading& reading) noexcept;

    // Consumer.
    [[nodiscard]] std::optional<Item> front() noexcept;
    void pop() noexcept;
    /// Returns the header of the `session` item at the front, and removes it from its list.
    [[nodiscard]] journal::Header take_session();
    /// Returns the reading of the `woken` item at the front, which stays there.
    [[nodiscard]] timing::ClockReading woken() noexcept;

    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

    /// Returns the number of bytes in use, stamps included.
    [[nodiscard]] std::size_t fill() const noexcept;

private:
    struct Entry {
        std::uint32_t kind = 0;
        std::uint32_t size = 0;
        std::int64_t raw_ns = 0;
    };
    static constexpr std::uint32_t kWrap = ~std::uint32_t{0};
    [[nodiscard]] static std::size_t room_for(std::size_t size) noexcept;
    [[nodiscard]] Entry entry_at(std::uint64_t position) const noexcept;
    void put_entry(std::uint64_t position, const Entry& entry) noexcept;

    std::size_t capacity_;
    std::unique_ptr<std::byte[]> ring_;
    std::atomic<std::uint64_t> head_{0};  ///< Position of the next item to take; never wraps.
    std::atomic<std::uint64_t> tail_{0};  ///< Position of the next item to write.
    std::mutex sessions_mutex_;
    std::deque<journal::Header> sessions_;
};

}  // namespace a351::daemon::source
