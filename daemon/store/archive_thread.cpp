#include "daemon/store/archive_thread.hpp"

#include <algorithm>
#include <utility>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::daemon::store {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kArchiveSyncInterval{30};
constexpr seconds kModelInterval{10};                // Instrument time, and
constexpr milliseconds kShortestModelInterval{100};  // real time.
constexpr milliseconds kWriteInterval{50};
constexpr std::size_t kSessionsRemembered = 8;  // Each has 24 h of times, up to 3.5 MB.

std::optional<survey::Instant> instant_of(const journal::SessionId& session,
                                          const timing::SampleClock& clock,
                                          std::optional<std::int64_t> index) {
    const auto time = index ? clock.time_of(*index) : std::nullopt;
    return time ? std::optional(survey::Instant{session, *index, time->utc}) : std::nullopt;
}

}  // namespace

ArchiveThread::ArchiveThread(files::FileLayer& files, std::filesystem::path archive,
                             journal::StationCodes codes, const source::HostClock& clock,
                             ChunkQueue& chunks, Progress& progress, SpaceReserve& reserve,
                             Hooks hooks, DiskTime time, std::size_t most_waiting_bytes,
                             const archive::RecoveryPlan& plan)
    : files_(files),
      archive_(std::move(archive)),
      codes_(std::move(codes)),
      clock_(clock),
      chunks_(chunks),
      progress_(progress),
      reserve_(reserve),
      hooks_(std::move(hooks)),
      time_(std::move(time)),
      most_waiting_bytes_(most_waiting_bytes),
      plan_(plan),
      last_sync_(time_.now()),
      retry_(0, time_),
      archiver_(std::make_unique<archive::Archiver>(outbox_)) {
    status_.is_replaying = true;
    outbox_.placed = [this](const archive::Sample& sample) {
        if (const auto placed = archiver_->clock()->time_of(sample.index))
            hooks_.sample(sample, placed->utc);
    };
}

ArchiveThread::~ArchiveThread() {
    if (!thread_.joinable()) return;
    chunks_.close();
    skip_waits();
    join();
}

void ArchiveThread::skip_waits() {
    const std::lock_guard lock(mutex_);
    is_hurried_ = true;
    changed_.notify_all();
}

bool ArchiveThread::join() {
    const bool is_started = thread_.joinable();
    if (is_started)
        thread_.join();
    else
        run();
    std::unique_lock lock(mutex_);
    is_ending_ = true;
    changed_.notify_all();
    lock.unlock();
    if (is_started)
        writing_thread_.join();
    else
        run_writing();
    lock.lock();
    return status_.trouble.empty() && status_.chunks_lost == 0;
}

void ArchiveThread::run() noexcept {
    hooks_.begin();
    NumberedChunk numbered;
    while (!recover()) {
        std::unique_lock lock(mutex_);
        const bool is_over =
            changed_.wait_for(lock, time_.retry_interval, [this] { return is_hurried_; });
        lock.unlock();
        if (!is_over && !chunks_.is_half_full()) continue;
        if (!is_over)
            note_fault(
                "adding the last run's data was given up until the next start, so that the "
                "journal need not wait");
        while (chunks_.pop(numbered)) {  // Dropped; the next start finds them in the journal.
        }
        return;
    }
    while (chunks_.pop(numbered)) {
        handle(numbered);
        wait_for_room();
    }
    const std::lock_guard lock(mutex_);
    // The next run may adopt this session; its replay then computes times not fixed yet.
    if (!has_recorded_ || archiver_->are_times_fixed()) archiver_->close_records();
}

void ArchiveThread::run_writing() noexcept {
    std::unique_lock lock(mutex_);
    while (!is_ending_) {
        changed_.wait_for(lock, kWriteInterval, [this] { return is_ending_; });
        if (is_ending_) continue;
        const bool is_replaying = status_.is_replaying;
        lock.unlock();
        look_at_space();
        if (!is_replaying && may_write() && retry_.may_try(time_.now())) store_records(false);
        lock.lock();
    }
    const bool is_left_to_next_start = status_.is_replaying;
    lock.unlock();
    // The journal is written, so the archive may use all remaining space.
    if (!is_left_to_next_start && !store_records(true)) store_records(true);
}

void ArchiveThread::step() {
    look_at_space();
    if (!recover()) return;
    NumberedChunk numbered;
    while (chunks_.try_pop(numbered)) handle(numbered);
    if (may_write() && retry_.may_try(time_.now())) store_records(false);
}

void ArchiveThread::handle(const NumberedChunk& numbered) noexcept {
    try {
        watch_clock(numbered.chunk);
        take(numbered);
        post_model();
    } catch (const std::exception& error) {
        note_fault(error.what());
        are_marks_true_ = false;  // No mark may claim that it is archived.
        const std::lock_guard lock(mutex_);
        ++status_.chunks_lost;
    }
}

/// Waits while the records that are being written fill the memory.  Drops the oldest if they cannot
/// be written: the archive refuses them, or the journal has not taken their chunks.
void ArchiveThread::wait_for_room() {
    std::unique_lock lock(mutex_);
    auto& entries = outbox_.entries;
    while (outbox_.bytes > most_waiting_bytes_ && !is_hurried_) {
        if (!entries.empty() && (is_refused_ || entries.front().chunk > progress_.written())) {
            outbox_.bytes -= entries.front().record.bytes.size();
            entries.pop_front();
            are_marks_true_ = false;  // No mark may claim that it is archived.
            ++status_.records_dropped;
        } else {
            changed_.wait_for(lock, kWriteInterval);
        }
    }
}

void ArchiveThread::watch_clock(const journal::Chunk& chunk) {
    const auto* const header = std::get_if<journal::Header>(&chunk);
    const auto* const reading =
        header != nullptr ? &header->clock : std::get_if<timing::ClockReading>(&chunk);
    const auto step = reading != nullptr ? clock_watch_.observe(*reading) : std::nullopt;
    if (!step) return;
    hooks_.clock_set(*step);
    const std::lock_guard lock(mutex_);
    status_.clock_step = step;
}

void ArchiveThread::take(const NumberedChunk& numbered) {
    const auto* const header = std::get_if<journal::Header>(&numbered.chunk);
    const std::lock_guard lock(mutex_);
    const bool is_next_session = header != nullptr && session_ != header->session;
    if (header != nullptr) begin_session(*header);
    outbox_.chunk = numbered.number;
    archiver_->take(numbered.chunk);
    if (is_next_session) outbox_.held.clear();  // Not before: the last session's records end now.
    if (header != nullptr) outbox_.session = header->session;
    status_.counters = archiver_->counters();
    status_.last_sample = outbox_.last_sample;
    if (outbox_.session)
        progress_.parsed(numbered.number, *outbox_.session, archiver_->last_index());
}

/// Handles a segment's header, of the running session or of a new one.
void ArchiveThread::begin_session(const journal::Header& header) {
    // The first header of a session has the time of its start.
    if (undescribed_.empty() || undescribed_.back().session != header.session)
        undescribed_.push_back(header);
    if (session_ != header.session) outbox_.last_sample.reset();
    note_session(header.session);
    has_recorded_ = true;
}

void ArchiveThread::note_session(const journal::SessionId& session) {
    const auto ended = std::exchange(session_, session);
    const auto last_index = archiver_->last_index();
    if (!ended || ended == session || !last_index) return;
    ended_.push_back({*ended, *archiver_->clock(), *last_index});
    if (ended_.size() > kSessionsRemembered) ended_.pop_front();
}

/// Looks at the free space, whatever the archive does: the reserve is the journal's.
void ArchiveThread::look_at_space() {
    if (time_.now() - last_look_at_space_ < kSpaceInterval) return;
    last_look_at_space_ = time_.now();
    reserve_.tend();
}

bool ArchiveThread::may_write() const {
    const std::lock_guard lock(mutex_);
    return may_archive(reserve_.is_space_short(), outbox_.bytes > most_waiting_bytes_);
}

/// Writes the waiting records.  @return false if writing failed; the rest waits.
bool ArchiveThread::store_records(bool is_last) {
    try {
        if (retry_.is_failing()) reopen();
        describe_sessions();
        write_outbox(is_last);
        if (is_last || time_.now() - last_sync_ >= kArchiveSyncInterval) sync();
    } catch (const std::exception& error) {
        note_fault(error.what());
        retry_.note_failure(time_.now());
        const std::lock_guard lock(mutex_);
        is_refused_ = true;
        return false;
    }
    retry_.note_success();
    const std::lock_guard lock(mutex_);
    is_refused_ = false;
    status_.trouble.clear();
    return true;
}

void ArchiveThread::note_fault(const std::string& trouble) {
    const std::lock_guard lock(mutex_);
    status_.trouble = trouble;
    ++status_.faults;
}

void ArchiveThread::describe_sessions() {
    std::unique_lock lock(mutex_);
    while (!undescribed_.empty()) {
        const journal::Header header = undescribed_.front();
        lock.unlock();
        hooks_.session_began(header);
        lock.lock();
        undescribed_.pop_front();
    }
}

/// Removes the next record whose chunk is in the journal; std::nullopt if there is none.
std::optional<ArchiveThread::Outbox::Entry> ArchiveThread::next_record() {
    const std::lock_guard lock(mutex_);
    auto& entries = outbox_.entries;
    if (entries.empty() || entries.front().chunk > progress_.written()) return std::nullopt;
    std::optional<Outbox::Entry> next(std::move(entries.front()));
    outbox_.bytes -= next->record.bytes.size();
    entries.pop_front();
    return next;
}

void ArchiveThread::write_outbox(bool is_last) {
    while (is_last || may_write()) {
        auto entry = next_record();
        if (!entry) break;
        try {
            write_record(*entry);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            outbox_.bytes += entry->record.bytes.size();
            outbox_.entries.push_front(std::move(*entry));
            throw;
        }
        const std::lock_guard lock(mutex_);
        ++status_.records;
    }
    // The replay is over, so that no later match helps to decide.
    writer_->settle();
    const std::lock_guard lock(mutex_);
    status_.conflicts = writer_->replay_conflicts();
}

void ArchiveThread::write_record(const Outbox::Entry& entry) {
    if (entry.session != marked_) {  // Marks never mix sessions.
        writer_->settle();  // The last session's records must be synced before the next one's mark.
        if (marked_) sync();
        writer_->end_replay();
        writer_->begin_session();
        marked_ = entry.session;
    }
    writer_->record(entry.channel, entry.record, entry.last_index);
}

void ArchiveThread::sync() {
    last_sync_ = time_.now();
    std::vector<journal::ChannelMark> marks;
    try {
        marks = writer_->sync();
    } catch (...) {
        // It is not known which data the kernel kept and which it dropped.
        are_marks_true_ = false;
        throw;
    }
    if (!marked_ || marks.empty() || !are_marks_true_) return;
    std::optional<std::int64_t> last;
    for (const auto& mark : marks) {
        if (archive::is_derived(mark.channel)) continue;
        last = std::min(last.value_or(mark.index), mark.index);
    }
    if (last) progress_.archive_synced(*marked_, *last);
    hooks_.post(journal::MarkChunk{*marked_, std::move(marks)});
}

void ArchiveThread::post_model() {
    const auto now = time_.now();
    if (now - last_model_real_ < kShortestModelInterval) return;
    const RawTime raw = clock_.raw();
    if (raw - last_model_ < kModelInterval) return;
    std::optional<journal::ModelChunk> model;
    {
        const std::lock_guard lock(mutex_);
        const auto index = archiver_->last_index();
        const auto* const sample_clock = archiver_->clock();
        if (!index || sample_clock == nullptr) return;
        const auto time = sample_clock->time_of(*index);
        if (time) model = journal::ModelChunk{*index, *time};
    }
    if (!model) return;
    last_model_ = raw;
    last_model_real_ = now;
    hooks_.post(*model);
}

/// Repairs and opens the archive after a fault, which may have left an incomplete record at the end
/// of a day file; nothing may be appended after that.
void ArchiveThread::reopen() {
    if (are_marks_true_) {
        try {
            static_cast<void>(writer_->sync());
        } catch (const std::system_error&) {
            are_marks_true_ = false;
        }
    }
    for (const std::string& channel : archive::channels_in(archive_, codes_))
        for (const auto& file : archive::recent_day_files(archive_, codes_, channel))
            archive::repair_tail(files_, file, archive::side_directory(archive_));
    writer_->reopen();
}

std::optional<survey::Instant> ArchiveThread::latest() {
    const std::lock_guard lock(mutex_);
    if (status_.is_replaying) return std::nullopt;
    if (const auto index = archiver_->last_index(); index && session_)
        return instant_of(*session_, *archiver_->clock(), index);
    if (ended_.empty()) return std::nullopt;
    return instant_of(ended_.back().session, ended_.back().clock, ended_.back().last_index);
}

std::optional<survey::Instant> ArchiveThread::at(UtcTime utc) {
    const std::lock_guard lock(mutex_);
    if (status_.is_replaying) return std::nullopt;
    for (const Ended& one : ended_)
        if (const auto found = instant_of(one.session, one.clock, one.clock.index_at(utc)))
            return found;
    const timing::SampleClock* const clock = archiver_->clock();
    if (clock == nullptr || !session_) return std::nullopt;
    return instant_of(*session_, *clock, clock->index_at(utc));
}

ArchiveStatus ArchiveThread::status() {
    const std::lock_guard lock(mutex_);
    ArchiveStatus status = status_;
    status.is_marking = are_marks_true_;
    status.records_waiting = outbox_.entries.size();
    if (const timing::SampleClock* const sample_clock = archiver_->clock()) {
        status.timing_state = sample_clock->state();
        status.timing_uncertainty = sample_clock->uncertainty();
        status.is_host_synchronised = sample_clock->is_host_synchronised();
        status.measured_rate = sample_clock->measured_rate();
    }
    return status;
}

}  // namespace a351::daemon::store
