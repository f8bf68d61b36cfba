#pragma once
/// @file
/// How far the record has come, as sample indices of the running session.  The journal knows
/// chunks, the archive knows samples; here they meet.

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::daemon {

class Progress {
public:
    struct Indices {
        std::optional<record::SessionId> session;
        std::optional<std::int64_t> received;   ///< Last sample parsed.
        std::optional<std::int64_t> journaled;  ///< Last one that survives a power cut.
        std::optional<std::int64_t> archived;   ///< Last one in a synced record, on all channels.
    };

    /// The archive thread has parsed a chunk; `last_index` is the session's last sample so far.
    void parsed(std::uint64_t chunk, const record::SessionId& session,
                std::optional<std::int64_t> last_index);

    /// Every chunk up to `chunk` is on disk.
    void journal_synced(std::uint64_t chunk);

    void archive_synced(const record::SessionId& session, std::int64_t index);

    [[nodiscard]] Indices indices() const;

private:
    struct Parsed {
        std::uint64_t chunk = 0;
        std::int64_t last_index = 0;
    };
    void advance();

    mutable std::mutex mutex_;
    Indices indices_;
    std::deque<Parsed> unsynced_;  ///< Parsed, not known to be synced; ascending.
    std::uint64_t synced_chunk_ = 0;
};

}  // namespace a351::daemon
