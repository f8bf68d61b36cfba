#pragma once
/// @file
/// All decisions of the store about a full or failing disk.  Its threads ask here.  The page for
/// operators is a351d(1), "FULL AND FAILING DISKS"; report() has the sentences of the status.
///
/// The journal has priority: archive and metadata can be made of it again.
///
///     situation                         what happens
///     more than two reserves free       a missing reserve is created (may_create_reserve)
///     less than a reserve free, or the  journal and event log use the rest; records wait in memory
///       reserve is given up               (is_space_short, may_archive); a replay waits too
///     the disk is full for journal,     the reserve is given up and the operation is repeated once
///       event log or start                (SpaceReserve::use_for); without a reserve it fails
///     memory of waiting records full    the excess is written even if space is short; if this fails,
///                                         or the journal has not taken it, the oldest are dropped
///     journal: a write or sync fails    repeated at once in a new segment, then at intervals (Retry)
///     archive: a write or sync fails    repeated at intervals, after a repair of the day files
///     an event cannot be written        it is refused, also if its turn does not come in time
///     one operation takes long          data wait in memory; the queue full: the reader waits
///     the journal is stuck (is_stuck)   the queue full: its oldest chunks are dropped (Overflow)
///     archive: a sync failed, a chunk   nothing is marked as archived until the next start, which
///       or record is lost                 replays the journal from the last mark
///     replay: fails                     repeated at intervals; given up until the next start when the
///                                         queue of the decoding thread is half full
///     closed segment: not compressed    repeated in the next round of the keeper
///     the daemon stops                  each part tries at once, the archive twice and into the last
///                                         byte; exit status 1 if something is missing
///     the daemon starts                 exit status 1 if the journal cannot be repaired

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "daemon/status/status.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon::store {

struct ArchiveStatus;
struct JournalStatus;

using SteadyTime = std::chrono::steady_clock::time_point;

/// The real time that journal and archive use for writing, syncing and trying again.
struct DiskTime {
    std::function<SteadyTime()> now = std::chrono::steady_clock::now;
    /// Time between tries after a file could not be written.
    std::chrono::milliseconds retry_interval{10'000};
};

/// Size of the reserve in bytes: half a day of journal at 50 Hz, 104 MB a day.
inline constexpr std::uint64_t kReserve_bytes = std::uint64_t{64} << 20;
/// Memory of records that wait for the archive: 18 h at 50 Hz.
inline constexpr std::size_t kWaitingRecords_bytes = std::size_t{64} << 20;
/// Longest time that an event waits for its turn.
inline constexpr std::chrono::seconds kCommitPatience{10};
/// Time between looks at the free space.  A disk can fill up within a minute.
inline constexpr std::chrono::seconds kSpaceInterval{1};

enum class ReserveState {
    present,
    given_up,     ///< The file was removed, or not created yet because space is short.
    unavailable,  ///< The file cannot be created.
};

/// @param free_bytes  absent if it is unknown.
[[nodiscard]] constexpr bool may_create_reserve(std::optional<std::uint64_t> free_bytes,
                                                std::uint64_t reserve_bytes) noexcept {
    return !free_bytes || *free_bytes > 2 * reserve_bytes;
}

/// Returns true if the remaining space is kept for the journal.
[[nodiscard]] constexpr bool is_space_short(ReserveState reserve,
                                            std::optional<std::uint64_t> free_bytes,
                                            std::uint64_t reserve_bytes) noexcept {
    return reserve == ReserveState::given_up || (free_bytes && *free_bytes < reserve_bytes);
}

/// Returns true if a record may be written now.
[[nodiscard]] constexpr bool may_archive(bool is_short, bool is_memory_full) noexcept {
    return !is_short || is_memory_full;
}

/// Decides when operations that failed are tried again.
class Retry {
public:
    /// @param at_once  number of failures after which the next try need not wait.
    Retry(int at_once, const DiskTime& time) : at_once_(at_once), interval_(time.retry_interval) {}

    void note_success() noexcept { failures_ = 0; }
    void note_failure(SteadyTime now) noexcept {
        ++failures_;
        last_ = now;
    }

    [[nodiscard]] bool is_faulty() const noexcept { return failures_ > 0; }
    /// Returns true if tries have to wait.
    [[nodiscard]] bool is_failing() const noexcept { return failures_ > at_once_; }
    /// Returns true within an interval after the last failure, also if it is over.
    [[nodiscard]] bool is_recent(SteadyTime now) const noexcept {
        return last_ && now - *last_ < interval_;
    }
    [[nodiscard]] bool may_try(SteadyTime now) const noexcept {
        return !is_failing() || !is_recent(now);
    }

private:
    int at_once_;
    std::chrono::milliseconds interval_;
    int failures_ = 0;  ///< Failures since the last success.
    std::optional<SteadyTime> last_;
};

/// Duration of one operation above which the journal's queue no longer waits for it.  Disks that
/// recover do so within the kernel's own time-out of 30 s and a repetition.
inline constexpr std::chrono::seconds kHopeless{60};

/// Returns true if the journal's queue no longer waits for the disk.
/// @param present  duration of the operation in progress.
[[nodiscard]] inline bool is_stuck(const Retry& retry, std::chrono::milliseconds present) noexcept {
    return retry.is_failing() || present > kHopeless;
}

/// The remedy for a full queue of chunks.
enum class Overflow { none, reader_waits, oldest_dropped };
[[nodiscard]] constexpr Overflow overflow_of(std::size_t queued_bytes, std::size_t capacity_bytes,
                                             bool is_stuck) noexcept {
    if (queued_bytes < capacity_bytes) return Overflow::none;
    return is_stuck ? Overflow::oldest_dropped : Overflow::reader_waits;
}

/// Returns true if the journal may lose a chunk so that newer ones are kept.
[[nodiscard]] inline bool is_expendable(const journal::Chunk& chunk) noexcept {
    return std::holds_alternative<journal::RxChunk>(chunk) ||
           std::holds_alternative<journal::TxChunk>(chunk) ||
           std::holds_alternative<journal::OvenChunk>(chunk) ||
           std::holds_alternative<timing::ClockReading>(chunk);
}

/// Adds what the parts of the store report to the status, in the words for an operator.  The reasons
/// have no number that varies, because the log distinguishes them by their text.
/// @param keeper           trouble of JournalKeeper; empty if none.
/// @param is_short         as is_space_short().
void report(const JournalStatus& journal, const ArchiveStatus& archive, const std::string& keeper,
            bool is_short, status::Status& status);

}  // namespace a351::daemon::store
