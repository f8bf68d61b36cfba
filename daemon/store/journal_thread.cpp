#include "daemon/store/journal_thread.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "protocol/core/invariant.hpp"

namespace a351::daemon::store {
namespace {

using std::chrono::milliseconds;

// Each chunk is an occasion to look whether a sync is due; without chunks there is a look after
// this time.  A sync is then at most 0.95 s after the one before.
constexpr milliseconds kSyncLookInterval{200};
constexpr milliseconds kJournalSyncInterval{750};  // In steps of 0.1 s: a sync each 0.8 s.

}  // namespace

JournalThread::JournalThread(files::FileLayer& files, const std::filesystem::path& data_root,
                             std::size_t capacity_bytes, Progress& progress, SpaceReserve& reserve,
                             DiskTime time)
    : time_(std::move(time)),
      files_(files),
      events_(data_root / "events"),
      capacity_bytes_(capacity_bytes),
      progress_(progress),
      reserve_(reserve),
      writer_(files, data_root / "journal"),
      retry_(1, time_) {}

JournalThread::~JournalThread() {
    if (!thread_.joinable()) return;
    drain();
    finish();
}

void JournalThread::start() {
    is_started_ = true;
    thread_ = std::thread([this] { run(); });
}

void JournalThread::drain() {
    std::unique_lock lock(mutex_);
    phase_ = Phase::draining;
    woken_.notify_all();
    if (thread_.joinable()) return woken_.wait(lock, [this] { return is_drained_; });
    lock.unlock();
    run_once(Phase::draining);
}

bool JournalThread::finish() {
    std::unique_lock lock(mutex_);
    phase_ = Phase::finishing;
    woken_.notify_all();
    lock.unlock();
    if (thread_.joinable())
        thread_.join();
    else
        run_once(Phase::finishing);
    lock.lock();
    return !retry_.is_faulty();
}

void JournalThread::push(std::uint64_t number, const journal::Chunk& chunk) {
    {
        const std::lock_guard lock(mutex_);
        queued_.push(number, chunk);
        while (overflow() == Overflow::oldest_dropped && drop_oldest()) {
        }
        has_news_ = true;
    }
    woken_.notify_all();
}

bool JournalThread::has_room() const {
    const std::lock_guard lock(mutex_);
    return overflow() != Overflow::reader_waits;
}

/// Must be called with the lock held.
Overflow JournalThread::overflow() const {
    return overflow_of(queued_.bytes(), capacity_bytes_, is_stuck(retry_, present_operation()));
}

/// Returns the duration of the disk operation in progress.  Must be called with the lock held.
milliseconds JournalThread::present_operation() const {
    if (!on_disk_since_) return milliseconds{0};
    return std::chrono::duration_cast<milliseconds>(time_.now() - *on_disk_since_);
}

/// Drops the oldest chunk that may be lost.  Must be called with the lock held.
/// @return false if there is none.
bool JournalThread::drop_oldest() {
    const auto oldest =
        std::ranges::find_if(queued_.chunks(), is_expendable, &NumberedChunk::chunk);
    if (oldest == queued_.chunks().end()) return false;
    if (const auto* const rx = std::get_if<journal::RxChunk>(&oldest->chunk))
        status_.reads_dropped += rx->reads.size();
    status_.is_dropping = true;
    queued_.erase(oldest);
    return true;
}

void JournalThread::commit(const events::Event& event, milliseconds patience) {
    const auto commit = std::make_shared<Commit>(Commit{event, {}});
    std::future<void> done = commit->done.get_future();
    {
        const std::lock_guard lock(mutex_);
        commits_.push_back(commit);
        woken_.notify_all();
    }
    if (!is_started_) step();
    if (done.wait_for(patience) != std::future_status::ready) {
        const std::lock_guard lock(mutex_);
        if (std::erase(commits_, commit) > 0) {
            throw std::system_error(std::make_error_code(std::errc::timed_out),
                                    "the event was not written in time because the disk is busy");
        }
    }
    done.get();  // Once begun it is waited for, so that the answer is always true.
}

void JournalThread::note(const events::Event& event) {
    const std::lock_guard lock(mutex_);
    commits_.push_back(std::make_shared<Commit>(Commit{event, {}}));
    woken_.notify_all();
}

JournalStatus JournalThread::status() const {
    const std::lock_guard lock(mutex_);
    JournalStatus status = status_;
    if (!retry_.is_faulty() && !retry_.is_recent(time_.now())) status.trouble.clear();
    status.present_sync = present_operation();
    status.longest_sync = std::max(status.longest_sync, status.present_sync);
    return status;
}

void JournalThread::run() noexcept {
    for (Phase phase = Phase::running; phase != Phase::finishing;) {
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, kSyncLookInterval, [this] {
            return has_news_ || !commits_.empty() || phase_ == Phase::finishing ||
                   (phase_ == Phase::draining && !is_drained_);
        });
        phase = phase_;
        has_news_ = false;
        lock.unlock();
        run_once(phase);
    }
}

void JournalThread::run_once(Phase phase) noexcept {
    try {
        work();
        if (phase != Phase::running) sync();
    } catch (const std::exception& error) {
        note_fault(error.what());
    }
    if (phase == Phase::running) {
        const std::lock_guard lock(mutex_);
        ++status_.rounds;
        return;
    }
    const std::lock_guard lock(mutex_);
    is_drained_ = true;
    woken_.notify_all();
}

void JournalThread::work() {
    if (may_try_again()) write_queued();
    while (const auto commit = next_commit()) carry_out(*commit);
    if (is_dirty_ && may_try_again() && time_.now() - last_sync_ >= kJournalSyncInterval) sync();
}

std::shared_ptr<JournalThread::Commit> JournalThread::next_commit() {
    const std::lock_guard lock(mutex_);
    if (commits_.empty()) return nullptr;
    auto first = std::move(commits_.front());
    commits_.pop_front();
    return first;
}

bool JournalThread::take_next() {
    const std::lock_guard lock(mutex_);
    is_unwritten_ = queued_.pop(taken_);
    return is_unwritten_;
}

void JournalThread::write_queued() {
    retry_unwritten();
    while (take_next()) retry_unwritten();
}

void JournalThread::retry_unwritten() {
    if (!is_unwritten_) return;
    const journal::Chunk& chunk = taken_.chunk;
    const auto* const header = std::get_if<journal::Header>(&chunk);
    if (header != nullptr) {
        on_disk([&] { writer_.begin_segment(*header); });
        has_segment_ = true;
    } else if (has_segment_) {
        on_disk([&] { writer_.append(chunk); });
    }
    is_dirty_ |= has_segment_;
    require_invariant(taken_.number == 0 || taken_.number > last_chunk_,
                      "chunks are written in their order, each once");
    if (taken_.number > 0) last_chunk_ = taken_.number;
    is_unwritten_ = false;
    progress_.journal_written(last_chunk_);
    const std::lock_guard lock(mutex_);
    status_.bytes_written = writer_.bytes_written();
}

// The event counts as written when it is in the event log.  The copy in the journal follows at
// once, or later after a fault of the journal.
void JournalThread::carry_out(Commit& commit) {
    try {
        on_disk([&] { events::append_event(files_, events_, commit.event); });
    } catch (const std::exception&) {
        std::unique_lock lock(mutex_);
        ++status_.events_refused;
        lock.unlock();
        return commit.done.set_exception(std::current_exception());
    }
    try {
        push(0, journal::EventChunk{events::to_json(commit.event)});
        if (may_try_again()) {
            write_queued();
            sync();
        }
    } catch (const std::exception& error) {
        note_fault(error.what());
    }
    commit.done.set_value();
}

void JournalThread::sync() {
    if (!is_dirty_) return;
    last_sync_ = time_.now();
    on_disk([this] { writer_.sync(); });
    is_dirty_ = false;
    {
        const std::lock_guard lock(mutex_);
        retry_.note_success();
        status_.is_dropping = false;
    }
    progress_.journal_synced(last_chunk_);
}

/// Runs a disk operation, if needed with the space of the reserve, and measures its time.
void JournalThread::on_disk(const std::function<void()>& operation) {
    {
        const std::lock_guard lock(mutex_);
        on_disk_since_ = time_.now();
    }
    const struct Measurement {
        JournalThread& thread;
        ~Measurement() {
            const std::lock_guard lock(thread.mutex_);
            auto& longest = thread.status_.longest_sync;
            longest = std::max(longest, thread.present_operation());
            thread.on_disk_since_.reset();
        }
    } measurement{*this};
    reserve_.use_for(operation);
}

void JournalThread::note_fault(const std::string& trouble) {
    const std::lock_guard lock(mutex_);
    retry_.note_failure(time_.now());
    status_.trouble = trouble;
    ++status_.faults;
}

bool JournalThread::may_try_again() const {
    const std::lock_guard lock(mutex_);
    return phase_ != Phase::running || retry_.may_try(time_.now());
}

}  // namespace a351::daemon::store
