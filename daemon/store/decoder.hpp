#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/believable/rate_watch.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/store/clock_watch.hpp"
#include "daemon/store/journal_thread.hpp"
#include "daemon/store/options.hpp"
#include "daemon/store/waiting_records.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/archiver.hpp"

namespace a351::daemon::store {

/// Makes samples, their times and records from the chunks, and answers which sample belongs to a
/// time.  The journal gets the time of the newest sample (MODEL).  The event log gets each step of
/// the clock, and each session whose start-up test has another result than the one before.
///
/// One thread decodes, any thread may ask.  The lock is held while a chunk is decoded.  This reads the
/// archive during a replay, and never waits for the disk afterwards.
class Decoder : public archive::Sink {
public:
    struct Status {
        archive::Counters counters;
        std::optional<archive::Sample> last_sample;
        timing::State timing_state = timing::State::unlocked;
        std::optional<Nanoseconds> timing_uncertainty;  ///< Absent before the first session.
        std::optional<Nanoseconds> host_uncertainty;    ///< Its part that is the host's clock.
        bool is_host_synchronised = false;
        std::optional<status::ClockStep> clock_step;    ///< Newest one of this run.
        std::optional<status::UnitChange> unit_change;  ///< Newest one within a survey day.
        std::optional<UtcTime> started_again;           ///< See Status::started_again.
        std::optional<timing::MeasuredRate> measured_rate;
        std::optional<Hertz> wrong_rate;  ///< See believable::RateWatch.
    };

    /// All objects passed by reference must outlive this.
    Decoder(const Options& options, const source::HostClock& clock, WaitingRecords& records,
            Progress& progress, JournalThread& journal);

    /// Forgets everything, for a replay of the last run from its begin.
    void begin_replay();
    /// Chooses the archive that holds the records of the chunks that follow.
    void replay_into(const archive::Writer& archive);
    /// Decodes a chunk of the last run.  @return true if it begins a session.
    bool replay(const journal::Chunk& chunk);
    /// Ends the replay.  An adopted stream continues the last session.
    /// @param held  records of the archive that the replay has not matched.
    /// @return the last session.
    std::optional<journal::SessionId> end_replay(archive::Writer::Held held);

    /// Decodes a chunk of this run.
    /// @throws what Archiver::take() throws.
    void take(const NumberedChunk& numbered);

    void close_records();
    /// Closes the records at the end of this run, unless the next run may adopt the session: its
    /// replay then computes times that are not fixed yet.
    void end_run();

    [[nodiscard]] std::optional<survey::Instant> latest() const;
    [[nodiscard]] std::optional<survey::Instant> at(UtcTime utc) const;
    /// See survey::Recorder::signal_since().
    [[nodiscard]] Nanoseconds signal_since(const journal::SessionId& session,
                                           std::int64_t index) const;
    /// See Store::set_day_end().
    void set_day_end(UtcTime end) { day_end_ = end; }
    [[nodiscard]] Status status() const;

private:
    /// A session that has ended and is still remembered.
    struct Ended {
        journal::SessionId session;
        timing::SampleClock clock;
        std::int64_t last_index = 0;
        Hertz rate;
    };

    void record(const std::string& channel, const archive::PackedRecord& record,
                std::int64_t last_index) override;
    void sample(const archive::Sample& sample) override;
    [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                UtcTime start) const override;
    bool begin_session(const journal::Chunk& chunk);
    void watch_clock(const journal::Chunk& chunk);
    void watch_rate(const journal::Chunk& chunk);
    [[nodiscard]] bool is_back(UtcTime utc) const;
    void expect_step(const status::ClockStep& step);
    void watch_time(UtcTime utc, bool is_first);
    void note_step(const status::ClockStep& step);
    void watch_sensor(const journal::Header& header);
    void report_other_unit(const journal::Header& header);
    [[nodiscard]] std::optional<survey::Instant> last_instant() const;
    void note_model();

    const Options& options_;
    const source::HostClock& clock_;
    WaitingRecords& records_;
    Progress& progress_;
    JournalThread& journal_;
    std::atomic<UtcTime> day_end_{UtcTime::min()};

    mutable std::mutex mutex_;  ///< Mutex of all that follows.
    std::unique_ptr<archive::Archiver> archiver_;
    const archive::Writer* archive_ = nullptr;  ///< Not null during a replay only.
    archive::Writer::Held held_;
    std::optional<journal::SessionId> session_;  ///< Session of archiver_.
    Hertz rate_{1.0};                            ///< Nominal rate of that session.
    /// Sensor and result of the start-up test in the last header.
    std::string serial_number_;
    wire::StartUpTest start_up_test_ = wire::StartUpTest::passed;
    std::deque<Ended> ended_;
    std::uint64_t chunk_ = 0;  ///< Number of the chunk that is being decoded; 0 in a replay.
    std::optional<journal::SessionId> record_session_;  ///< Session of the records being made.
    std::optional<archive::Sample> last_sample_;
    std::optional<UtcTime> newest_;  ///< Time of the newest sample, also of the last run.
    /// Step back that was noted and that no sample has shown yet.
    std::optional<Nanoseconds> expected_;
    bool has_recorded_ = false;  ///< This run recorded a session or a part of one.
    ClockWatch clock_watch_;
    std::optional<believable::RateWatch> rate_watch_;  ///< Absent before a session.
    SteadyTime last_model_real_;
    RawTime last_model_;
    Status status_;
};

}  // namespace a351::daemon::store
