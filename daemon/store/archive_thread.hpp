#pragma once
/// @file
/// The archive thread: journal chunks -> samples, times, miniSEED records.  First those that the
/// last run left in the journal, so that acquisition need not wait for them.  While the archive
/// cannot be written, or the journal needs the space that is left, records wait in memory, tried
/// now and then, and the journal goes on: 64 MiB here, 18 h at 50 Hz.  Then they are written if
/// they can be, or else wait in ChunkQueue; from then on the journal waits.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/source/host_clock.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/disk_time.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/archive/recovery.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon {

struct ArchiveStatus {
    bool is_faulty = false;
    std::string trouble;
    std::uint64_t faults = 0;
    std::uint64_t chunks_lost = 0;  ///< Not parsed; the journal holds them.
    /// False once a sync failed or a chunk was lost: nothing is marked until the next start, which
    /// replays the journal from the last mark.
    bool is_marking = true;
    bool is_replaying = false;  ///< The journal of the last run is being brought in.
    std::uint64_t records = 0;
    std::uint64_t records_waiting = 0;
    std::uint64_t conflicts = 0;  ///< Records that the archive holds otherwise: left as they are.
    record::ArchiverCounters counters;
    std::optional<record::Sample> last_sample;
    timing::TimingState timing_state = timing::TimingState::unlocked;
    std::optional<Nanoseconds> timing_uncertainty;  ///< Absent before the first session.
    std::optional<timing::MeasuredRate> measured_rate;
};

class ArchiveThread {
public:
    struct Hooks {
        /// Takes MARK and MODEL chunks on their way to the journal.
        std::function<void(record::JournalChunk)> post;
        /// A session begins: time to describe the instrument.
        std::function<void(const record::JournalHeader&)> session_began;
        /// The archive is up to the journal of the last run.
        std::function<void(const record::RecoveryReport&)> recovered;
        /// Before anything is read or written.
        std::function<void()> begin;
        /// Each sample that gets its place, those of the last run's journal included.
        std::function<void(const record::Sample&, UtcTime)> sample;
    };

    /// All referred to must outlive this.
    ArchiveThread(record::FileLayer& files, std::filesystem::path archive,
                  record::StationCodes codes, const HostClock& clock, ChunkQueue& chunks,
                  Progress& progress, SpaceReserve& reserve, Hooks hooks, DiskTime time,
                  const record::RecoveryPlan& plan);
    ~ArchiveThread();

    void start();

    /// What has come, in the caller's thread, for who does without start().
    void step();

    /// From now on nothing is waited for: a fault at the end is retried once, a replay is left to the
    /// next start.
    void hurry();

    /// Waits until the queue was closed and everything is in the archive, synced and marked.
    /// @return false when something could not be written.
    bool join();

    [[nodiscard]] std::optional<Instant> latest();
    [[nodiscard]] std::optional<Instant> at(UtcTime utc);
    [[nodiscard]] ArchiveStatus status();

private:
    /// Holds records until they are written, outside the lock.
    class Outbox : public record::ArchiveSink {
    public:
        struct Entry {
            std::optional<record::SessionId> session;
            std::string channel;
            record::PackedRecord record;
            std::int64_t last_index = 0;
        };
        void record(const std::string& channel, const record::PackedRecord& record,
                    std::int64_t last_index) override {
            bytes += record.bytes.size();
            entries.push_back({session, channel, record, last_index});
        }
        void sample(const record::Sample& sample) override {
            last_sample = sample;
            placed(sample);
        }
        [[nodiscard]] std::optional<std::size_t> samples_held(const std::string& channel,
                                                              UtcTime start) const override {
            return writer->samples_held(channel, start);
        }

        const record::ArchiveWriter* writer = nullptr;  ///< Never null while records come.
        std::optional<record::SessionId> session;       ///< Of what comes.
        std::deque<Entry> entries;
        std::size_t bytes = 0;
        std::optional<record::Sample> last_sample;
        std::function<void(const record::Sample&)> placed;
    };

    /// A session that is over but still remembered.
    struct Ended {
        record::SessionId session;
        timing::SampleClock clock;
        std::int64_t last_index = 0;
    };

    void run() noexcept;
    [[nodiscard]] bool recover() noexcept;
    [[nodiscard]] bool replay(record::RecoveryReport& report);
    void close_replayed();
    [[nodiscard]] bool take_again(const record::JournalChunk& chunk);
    void handle(const NumberedChunk& numbered) noexcept;
    void take(const NumberedChunk& numbered);
    void open_archive(const record::StationCodes& codes);
    void write_replayed();
    void begin_session(const record::JournalHeader& header);
    void note_session(const record::SessionId& session);
    [[nodiscard]] bool may_write();
    bool put_away(bool is_last);
    void write_outbox();
    void sync();
    void note_fault(const std::string& trouble);
    void post_model();
    void reopen();

    record::FileLayer& files_;
    std::filesystem::path archive_;
    record::StationCodes codes_;
    const HostClock& clock_;
    ChunkQueue& chunks_;
    Progress& progress_;
    SpaceReserve& reserve_;
    Hooks hooks_;
    DiskTime time_;
    const record::RecoveryPlan& plan_;

    using steady_time = std::chrono::steady_clock::time_point;

    // Of the archive thread.
    std::unique_ptr<record::ArchiveWriter> writer_;
    steady_time last_sync_, last_model_real_, last_look_at_space_;
    RawTime last_model_;
    std::optional<steady_time> retry_at_;            ///< Set while the archive is in trouble.
    std::deque<record::JournalHeader> undescribed_;  ///< Sessions whose metadata are to be written.
    std::atomic<bool> are_marks_true_{true};
    std::optional<record::SessionId> marked_;  ///< Session of the writer's records.

    mutable std::mutex mutex_;  ///< Of archiver_ and what it feeds; short, no disk below it.
    std::condition_variable hurried_;
    bool has_recorded_ = false;  ///< A session, or more of one, in this run.
    bool is_hurried_ = false;
    Outbox outbox_;
    std::unique_ptr<record::Archiver> archiver_;
    std::optional<record::SessionId> session_;  ///< Of archiver_.
    std::deque<Ended> ended_;
    ArchiveStatus status_;
    std::thread thread_;
};

}  // namespace a351::daemon
