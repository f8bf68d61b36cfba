#pragma once
/// @file
/// From the reader thread to the journal thread: one producer, one consumer, no lock and no
/// allocation for bytes, fixed capacity.

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

namespace a351::daemon {

class ReadQueue {
public:
    enum class Kind : std::uint32_t {
        rx,       ///< What one read() returned.
        tx,       ///< What was sent.
        session,  ///< What follows belongs to a new session: take_session().
        woken,    ///< The host slept before what follows: push_woken().
    };
    struct Item {
        Kind kind = Kind::rx;
        RawTime time;
        std::span<const std::byte> bytes;  ///< Valid until pop().
    };

    /// One hour at 50 Hz is 180 000 reads of 24 bytes, 48 with their stamp: 8.7 MB, doubled to
    /// the next power of two.  Memory that was never filled is not resident.
    static constexpr std::size_t kCapacity = std::size_t{16} << 20;
    static constexpr std::size_t kLargestItem = 4096;

    /// @param capacity  a power of two, > 2 kLargestItem.
    explicit ReadQueue(std::size_t capacity = kCapacity);

    // Producer.
    /// @param bytes  at most kLargestItem.  @return false when there is no room.
    [[nodiscard]] bool push(Kind kind, RawTime time, std::span<const std::byte> bytes) noexcept;
    /// Allocates; sessions are rare.
    [[nodiscard]] bool push_session(record::JournalHeader header, RawTime time);
    /// @param reading  no later than what follows.
    [[nodiscard]] bool push_woken(const timing::ClockReading& reading) noexcept;

    // Consumer.
    [[nodiscard]] std::optional<Item> front() noexcept;
    void pop() noexcept;
    /// The header of the `session` item at the front.
    [[nodiscard]] record::JournalHeader take_session();
    /// The reading of the `woken` item at the front, which stays.
    [[nodiscard]] timing::ClockReading woken() noexcept;

    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

    /// Bytes in use, stamps included.
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
    std::atomic<std::uint64_t> head_{0};  ///< Next to take; positions never wrap.
    std::atomic<std::uint64_t> tail_{0};  ///< Next to fill.
    std::mutex sessions_mutex_;
    std::deque<record::JournalHeader> sessions_;
};

}  // namespace a351::daemon
