#pragma once
/// @file
/// Everything between the reader's queue and the disk: chunks, recovery at start, journal, archive,
/// station metadata, events.  It also answers the requests of survey and page about recorded data.

#include <cerrno>
#include <cstdint>
#include <system_error>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/status/status.hpp"
#include "daemon/store/archive_thread.hpp"
#include "daemon/store/chunk_maker.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/data_root.hpp"
#include "daemon/store/journal_thread.hpp"
#include "daemon/store/options.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/archive/recovery.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/journal/stream_end.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::store {

class Store : public survey::Recorder {
public:
    /// Locks the data root and repairs its journal.  The references must outlive this.
    /// @throws DataRootLocked, std::system_error
    Store(files::FileLayer& files, Options options, const source::HostClock& clock,
          source::ReadQueue& reads);
    ~Store() override { stop(); }

    /// Returns the end of the stream that the journal contains; std::nullopt if there is none.
    [[nodiscard]] const std::optional<journal::StreamEnd>& known_stream() const noexcept {
        return known_stream_;
    }

    /// Starts recording; the archive is recovered at the same time.
    void start();

    /// Runs one round of all threads in the caller's thread; for tests that do
    /// not call start().
    void step();

    /// Writes the rest of the reader's queue, then closes and syncs everything.
    /// @return false if something could not be written.
    bool stop();

    [[nodiscard]] std::optional<survey::Instant> latest() override { return archive_.latest(); }
    [[nodiscard]] std::optional<survey::Instant> at(UtcTime utc) override {
        return archive_.at(utc);
    }
    [[nodiscard]] Nanoseconds signal_since(const journal::SessionId& session,
                                           std::int64_t index) override {
        return archive_.signal_since(session, index);
    }
    void commit(const events::Event& event) override {
        if (!lock_.is_in_place())
            throw std::system_error(ENOENT, std::generic_category(), options_.root.string());
        journal_.commit(event, options_.commit_patience);
    }

    void note(const events::Event& event) override {
        if (lock_.is_in_place()) journal_.note(event);
    }

    /// Sets the end of the survey day: another sensor that begins to record before is reported in the
    /// status.
    void set_day_end(UtcTime end) { archive_.set_day_end(end); }

    /// Passes a poll to journal and archive.  It is dropped before the sensor's first session, which
    /// opens the journal.
    void post(journal::OvenChunk poll) { chunk_maker_.post(std::move(poll)); }

    /// Returns true if chunks were made since the last call, and the journal thread finished a round
    /// or waits for the disk.  While it waits, data are in memory only, and a restart would lose them.
    [[nodiscard]] bool is_alive();

    /// Copies the state of the store into the status, and adds its reasons.
    void fill(status::Status& status);

private:
    files::FileLayer& files_;
    Options options_;
    SteadyTime began_;
    DataRootLock lock_;
    JournalKeeper keeper_;
    SpaceReserve reserve_;
    archive::RecoveryPlan plan_;
    std::optional<journal::StreamEnd> known_stream_;
    const wire::DeviceProfile* profile_;
    Progress progress_;
    ChunkQueue chunks_;
    JournalThread journal_;
    ChunkMaker chunk_maker_;
    ArchiveThread archive_;
    bool is_running_ = false;
    std::uint64_t rounds_ = 0, journal_rounds_ = 0;  ///< Rounds at the last call of is_alive().
};

}  // namespace a351::daemon::store
