#pragma once
/// @file
/// Progress of recording as sample indices of the running session.  It joins the journal's count in
/// chunks with the archive's count in samples.

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::daemon::store {

class Progress {
public:
    struct Indices {
        std::optional<journal::SessionId> session;
        std::optional<std::int64_t> received;   ///< Last sample parsed.
        std::optional<std::int64_t> journaled;  ///< Last sample that survives a power cut.
        std::optional<std::int64_t> archived;   ///< Last sample in synced records of all channels.
    };

    /// Notes that the archive thread parsed a chunk; `last_index` is the session's last one so far.
    /// If it is smaller than before, the sensor's counter restarted, and all is counted from there.
    void parsed(std::uint64_t chunk, const journal::SessionId& session,
                std::optional<std::int64_t> last_index);

    /// Notes that every chunk up to `chunk` was written to the journal, or dropped by it.
    void journal_written(std::uint64_t chunk);

    /// Returns the last chunk that was written.  Later ones must not be archived yet.
    [[nodiscard]] std::uint64_t written() const;

    /// Notes that every chunk up to `chunk` is on disk.
    void journal_synced(std::uint64_t chunk);

    /// Notes that all samples up to `index` are in synced records.
    void archive_synced(const journal::SessionId& session, std::int64_t index);

    [[nodiscard]] Indices indices() const;

private:
    struct Parsed {
        std::uint64_t chunk = 0;
        std::int64_t last_index = 0;
    };
    void advance();

    mutable std::mutex mutex_;
    Indices indices_;
    std::deque<Parsed> unsynced_;  ///< Chunks parsed but not known to be synced; ascending.
    std::uint64_t written_chunk_ = 0, synced_chunk_ = 0;
    std::optional<std::int64_t> before_restart_;  ///< Last index before the counter restarted.
    std::int64_t last_synced_ = -1;               ///< Last index that the archive reported.
};

}  // namespace a351::daemon::store
