#pragma once
/// @file
/// The archive thread: journal chunks -> samples, times, miniSEED records.  A slow or full disk
/// holds it up without harm until ChunkQueue is full; from then on the journal waits for it.

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/record/archive_writer.hpp"
#include "protocol/record/archiver.hpp"
#include "protocol/record/file_layer.hpp"

namespace a351::daemon {

struct ArchiveStatus {
    bool is_faulty = false;
    std::string trouble;
    std::uint64_t faults = 0;
    std::uint64_t records = 0;
    record::ArchiverCounters counters;
    std::optional<record::Sample> last_sample;
    timing::TimingState timing_state = timing::TimingState::unlocked;
    Nanoseconds timing_uncertainty{0};
};

class ArchiveThread {
public:
    struct Hooks {
        /// Takes MARK and MODEL chunks on their way to the journal.
        std::function<void(record::JournalChunk)> post;
        /// A session begins: time to describe the instrument.  May throw std::system_error.
        std::function<void(const record::JournalHeader&)> session_began;
    };

    /// All referred to must outlive this.
    ArchiveThread(record::FileLayer& files, std::filesystem::path archive,
                  record::StationCodes codes, const HostClock& clock, ChunkQueue& chunks,
                  Progress& progress, Hooks hooks);
    ~ArchiveThread();

    void start();

    /// From now on a fault is retried once, not for ever.
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
            std::string channel;
            record::PackedRecord record;
            std::int64_t last_index = 0;
        };
        void record(const std::string& channel, const record::PackedRecord& record,
                    std::int64_t last_index) override {
            entries.push_back({channel, record, last_index});
        }
        void sample(const record::Sample& sample) override { last_sample = sample; }

        std::vector<Entry> entries;
        std::optional<record::Sample> last_sample;
    };

    void run() noexcept;
    void take(const NumberedChunk& numbered);
    void persist(const std::function<void()>& step);
    void write_outbox();
    void end_session();
    void sync();
    void post_model();
    void reopen();
    [[nodiscard]] std::optional<Instant> instant_of(std::int64_t index);

    record::FileLayer& files_;
    std::filesystem::path archive_;
    record::StationCodes codes_;
    const HostClock& clock_;
    ChunkQueue& chunks_;
    Progress& progress_;
    Hooks hooks_;

    // Of the archive thread.
    std::unique_ptr<record::ArchiveWriter> writer_;
    std::chrono::steady_clock::time_point last_sync_, last_model_real_;
    RawTime last_model_;
    bool are_marks_true_ = true;
    std::optional<record::SessionId> marked_;  ///< Session of the writer's records.

    mutable std::mutex mutex_;  ///< Of archiver_ and what it feeds; short, no disk below it.
    std::condition_variable hurried_;
    bool is_hurried_ = false;
    Outbox outbox_;
    record::Archiver archiver_;
    std::optional<record::SessionId> session_;
    ArchiveStatus status_;
    std::thread thread_;
};

}  // namespace a351::daemon
