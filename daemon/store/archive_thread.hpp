#pragma once
/// @file
/// From chunks to samples, times and miniSEED records, by two threads.  The first decodes, and never
/// waits for the disk once the chunks that the last run left in the journal are processed;
/// acquisition does not wait for them.  The second writes a record when the journal holds its chunk.
/// What they do on a full or failing disk is in disk_policy.hpp.

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
#include "daemon/status/status.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/clock_watch.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/archive/recovery.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon::store {

struct ArchiveStatus {
    std::string trouble;  ///< Text of the last fault; empty if it is over.
    std::uint64_t faults = 0;
    std::uint64_t chunks_lost = 0;  ///< Chunks that could not be parsed; they are in the journal.
    std::uint64_t records_dropped = 0;  ///< Records dropped because they waited for too long.
    /// False after a failed sync, a lost chunk or a dropped record: nothing is marked as archived
    /// until the next start, which replays the journal from the last mark.
    bool is_marking = true;
    bool is_replaying = false;  ///< The last run's journal is being added to the archive.
    std::uint64_t records = 0;
    std::uint64_t records_waiting = 0;
    std::uint64_t conflicts = 0;  ///< Records that differ from the archive's, which are kept.
    archive::Counters counters;
    std::optional<archive::Sample> last_sample;
    timing::State timing_state = timing::State::unlocked;
    std::optional<Nanoseconds> timing_uncertainty;  ///< Absent before the first session.
    bool is_host_synchronised = false;
    std::optional<status::ClockStep> clock_step;  ///< Newest one of this run.
    std::optional<timing::MeasuredRate> measured_rate;
};

class ArchiveThread {
public:
    struct Hooks {
        /// Receives MARK and MODEL chunks for the journal.
        std::function<void(journal::Chunk)> post;
        /// Called when a session begins, to describe the instrument.
        std::function<void(const journal::Header&)> session_began;
        /// Called when the sample times follow a step of the host's clock.  Must not wait.
        std::function<void(const status::ClockStep&)> clock_set;
        /// Called when the last run's journal is completely in the archive.
        std::function<void(const archive::RecoveryReport&)> recovered;
        /// Called before anything is read or written.
        std::function<void()> begin;
        /// Called for each sample with index and time, also those of the last run's journal.
        std::function<void(const archive::Sample&, UtcTime)> sample;
    };

    /// All objects passed by reference must outlive this.
    ArchiveThread(files::FileLayer& files, std::filesystem::path archive,
                  journal::StationCodes codes, const source::HostClock& clock, ChunkQueue& chunks,
                  Progress& progress, SpaceReserve& reserve, Hooks hooks, DiskTime time,
                  std::size_t most_waiting_bytes, const archive::RecoveryPlan& plan);
    ~ArchiveThread();

    void start() {
        thread_ = std::thread([this] { run(); });
        writing_thread_ = std::thread([this] { run_writing(); });
    }

    /// Processes pending input in the caller's thread; for tests that do not call start().
    void step();

    /// Ends all waiting from now on: a fault at the end is retried once, and a replay is left to
    /// the next start.
    void skip_waits();

    /// Waits until the queue is closed and everything is in the archive, synced and marked.
    /// @return false if something could not be written.
    bool join();

    [[nodiscard]] std::optional<survey::Instant> latest();
    [[nodiscard]] std::optional<survey::Instant> at(UtcTime utc);
    [[nodiscard]] ArchiveStatus status();

private:
    /// Keeps records until they are written, which is done without the lock.
    class Outbox : public archive::Sink {
    public:
        struct Entry {
            std::uint64_t chunk = 0;  ///< The journal must hold this chunk first.
            std::optional<journal::SessionId> session;
            std::string channel;
            archive::PackedRecord record;
            std::int64_t last_index = 0;
        };
        void record(const std::string& channel, const archive::PackedRecord& record,
                    std::int64_t last_index) override {
            bytes += record.bytes.size();
            entries.push_back({chunk, session, channel, record, last_index});
        }
        void sample(const archive::Sample& sample) override {
            last_sample = sample;
            placed(sample);
        }
        [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                    UtcTime start) const override {
            if (writer != nullptr) return writer->samples_in_archive(channel, start);
            const auto records = held.find(channel);
            if (records == held.end()) return std::nullopt;
            const auto record = records->second.find(start);
            return record == records->second.end() ? std::nullopt : std::optional(record->second);
        }

        const archive::Writer* writer = nullptr;  ///< Not null during the replay only.
        archive::Writer::Held held;  ///< Records of the archive that the replay has not matched.
        std::uint64_t chunk = 0;     ///< Number of the chunk that is being decoded.
        std::optional<journal::SessionId> session;  ///< Session of the records being received.
        std::deque<Entry> entries;
        std::size_t bytes = 0;
        std::optional<archive::Sample> last_sample;
        std::function<void(const archive::Sample&)> placed;
    };

    /// A session that has ended and is still remembered.
    struct Ended {
        journal::SessionId session;
        timing::SampleClock clock;
        std::int64_t last_index = 0;
    };

    void run() noexcept;
    [[nodiscard]] bool recover() noexcept;
    [[nodiscard]] bool replay(archive::RecoveryReport& report);
    [[nodiscard]] bool replay_chunk(const journal::Chunk& chunk);
    void handle(const NumberedChunk& numbered) noexcept;
    void wait_for_room();
    void run_writing() noexcept;
    void take(const NumberedChunk& numbered);
    void watch_clock(const journal::Chunk& chunk);
    void open_archive(const journal::StationCodes& codes);
    void write_replayed();
    void begin_session(const journal::Header& header);
    void note_session(const journal::SessionId& session);
    void look_at_space();
    [[nodiscard]] bool may_write() const;
    bool store_records(bool is_last);
    void describe_sessions();
    [[nodiscard]] std::optional<Outbox::Entry> next_record();
    void write_outbox(bool is_last);
    void write_record(const Outbox::Entry& entry);
    void sync();
    void note_fault(const std::string& trouble);
    void post_model();
    void reopen();

    files::FileLayer& files_;
    std::filesystem::path archive_;
    journal::StationCodes codes_;
    const source::HostClock& clock_;
    ChunkQueue& chunks_;
    Progress& progress_;
    SpaceReserve& reserve_;
    Hooks hooks_;
    DiskTime time_;
    std::size_t most_waiting_bytes_;
    const archive::RecoveryPlan& plan_;

    // Used by the decoding thread only.
    SteadyTime last_model_real_;
    RawTime last_model_;
    ClockWatch clock_watch_;

    // Used by the decoding thread during the replay, then by the writing thread only.
    std::unique_ptr<archive::Writer> writer_;
    SteadyTime last_sync_, last_look_at_space_;
    Retry retry_;
    std::optional<journal::SessionId> marked_;  ///< Session of the records in the writer.

    std::atomic<bool> are_marks_true_{true};

    mutable std::mutex mutex_;  ///< Mutex of all that follows; not locked for disk access.
    std::condition_variable changed_;
    bool is_refused_ = false;  ///< The last try to write records failed.
    bool is_ending_ = false;   ///< Everything is decoded, and in the journal if it could be.
    std::deque<journal::Header> undescribed_;  ///< Sessions whose metadata must be written.
    bool has_recorded_ = false;                ///< This run recorded a session or a part of one.
    bool is_hurried_ = false;
    Outbox outbox_;
    std::unique_ptr<archive::Archiver> archiver_;
    std::optional<journal::SessionId> session_;  ///< Session of archiver_.
    std::deque<Ended> ended_;
    ArchiveStatus status_;
    std::thread thread_, writing_thread_;
};

}  // namespace a351::daemon::store
