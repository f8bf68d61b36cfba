#include "daemon/store/journal_thread.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace a351::daemon::store {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kWriteInterval{50};  // Half of the promised 100 ms; the disk takes the rest.
constexpr milliseconds kJournalSyncInterval{800};  // Leaves 0.2 s of the promised 1 s.
constexpr seconds kClockInterval{1};  // Time between two clock readings: instrument time,
constexpr milliseconds kShortestClockInterval{100};  // and real time.
// Most bytes in a chunk.  With 12 bytes per stamp a chunk stays below the largest size.
constexpr std::size_t kMostBytes = std::size_t{48} << 10;
constexpr std::size_t kMostReads = 1000;
// Most chunks that wait: almost three hours of the oven's polls, one a second, while writing fails.
constexpr std::size_t kMostPosted = 10'000;

}  // namespace

JournalThread::JournalThread(files::FileLayer& files, const std::filesystem::path& data_root,
                             const source::HostClock& clock, source::ReadQueue& reads,
                             ChunkQueue& written, Progress& progress, SpaceReserve& reserve,
                             DiskTime time)
    : time_(std::move(time)),
      files_(files),
      events_(data_root / "events"),
      clock_(clock),
      reads_(reads),
      written_(written),
      progress_(progress),
      reserve_(reserve),
      writer_(files, data_root / "journal") {}

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
    return !status_.is_faulty;
}

void JournalThread::post(journal::Chunk chunk) {
    const std::lock_guard lock(mutex_);
    if (posted_.size() >= kMostPosted) {
        const auto is_poll = [](const journal::Chunk& posted) {
            return std::holds_alternative<journal::OvenChunk>(posted);
        };
        const auto oldest = std::find_if(posted_.begin(), posted_.end(), is_poll);
        if (oldest != posted_.end()) posted_.erase(oldest);
    }
    posted_.push_back(std::move(chunk));
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

JournalStatus JournalThread::status() const {
    const std::lock_guard lock(mutex_);
    JournalStatus status = status_;
    status.is_faulty |= is_fault_recent();
    if (on_disk_since_) {
        status.present_sync =
            std::chrono::duration_cast<milliseconds>(time_.now() - *on_disk_since_);
        status.longest_sync = std::max(status.longest_sync, status.present_sync);
    }
    return status;
}

void JournalThread::run() noexcept {
    for (Phase phase = Phase::running; phase != Phase::finishing;) {
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, kWriteInterval, [this] {
            return !commits_.empty() || phase_ == Phase::finishing ||
                   (phase_ == Phase::draining && !is_drained_);
        });
        phase = phase_;
        lock.unlock();
        run_once(phase);
    }
}

void JournalThread::run_once(Phase phase) noexcept {
    try {
        work(phase);
        if (phase != Phase::running) sync();
    } catch (const std::exception& error) {
        note_fault(error.what());
    }
    if (phase == Phase::running) {
        const std::lock_guard lock(mutex_);
        ++status_.rounds;
        return;
    }
    written_.close();
    const std::lock_guard lock(mutex_);
    is_drained_ = true;
    woken_.notify_all();
}

template <class Item>
std::optional<Item> JournalThread::take_first(std::deque<Item>& items) {
    const std::lock_guard lock(mutex_);
    if (items.empty()) return std::nullopt;
    std::optional<Item> first(std::move(items.front()));
    items.pop_front();
    return first;
}

void JournalThread::work(Phase phase) {
    make_room();
    if (may_try_again()) {
        retry_unwritten();
        write_reads();
        // After draining the archive would not see this chunk, but a reader of the journal would.
        if (phase == Phase::running && is_clock_due()) write_clock(clock_.read());
        while (auto chunk = take_first(posted_)) write(std::move(*chunk));
    }
    while (const auto commit = take_first(commits_)) carry_out(**commit);
    if (is_dirty_ && may_try_again() && time_.now() - last_sync_ >= kJournalSyncInterval) sync();
}

/// Drops the oldest reads when the queue is almost full and writing fails.  A session's header is
/// kept: it replaces the chunk that waits to be written.
void JournalThread::make_room() {
    if (faults_running_ < 2) return;
    std::uint64_t dropped = 0;
    while (reads_.fill() > reads_.capacity() / 8 * 7) {
        const auto kind = reads_.front()->kind;
        if (kind == source::ReadQueue::Kind::rx) ++dropped;
        if (kind == source::ReadQueue::Kind::session) {
            const auto* const rx =
                unwritten_ ? std::get_if<journal::RxChunk>(&*unwritten_) : nullptr;
            if (rx != nullptr) dropped += rx->reads.size();
            unwritten_ = reads_.take_session();
        }
        reads_.pop();
    }
    const std::lock_guard lock(mutex_);
    status_.reads_dropped += dropped;
}

void JournalThread::write_reads() {
    journal::RxChunk rx;
    const auto write_rx = [&] {
        if (!rx.reads.empty()) write(std::exchange(rx, {}));
    };
    while (const auto item = reads_.front()) {
        if (item->kind != source::ReadQueue::Kind::rx ||
            rx.bytes.size() + item->bytes.size() > kMostBytes || rx.reads.size() == kMostReads) {
            write_rx();
        }
        switch (item->kind) {
            case source::ReadQueue::Kind::rx:
                rx.bytes.insert(rx.bytes.end(), item->bytes.begin(), item->bytes.end());
                rx.reads.push_back({static_cast<std::uint32_t>(rx.bytes.size()), item->time});
                reads_.pop();
                break;
            case source::ReadQueue::Kind::tx: {
                journal::TxChunk tx{item->time, {item->bytes.begin(), item->bytes.end()}};
                reads_.pop();
                write(std::move(tx));
                break;
            }
            case source::ReadQueue::Kind::woken: {
                const timing::ClockReading reading = reads_.woken();
                reads_.pop();
                write_clock(reading);
                break;
            }
            case source::ReadQueue::Kind::session: {
                journal::Header header = reads_.take_session();
                reads_.pop();
                write(std::move(header));
                break;
            }
        }
    }
    write_rx();
}

bool JournalThread::is_clock_due() const {
    return has_segment_ && time_.now() - last_clock_real_ >= kShortestClockInterval &&
           clock_.raw() - last_clock_ >= kClockInterval;
}

void JournalThread::write_clock(const timing::ClockReading& reading) {
    last_clock_ = reading.raw;
    last_clock_real_ = time_.now();
    write(reading);
}

void JournalThread::write(journal::Chunk chunk) {
    unwritten_ = std::move(chunk);
    retry_unwritten();
}

void JournalThread::retry_unwritten() {
    if (!unwritten_) return;
    const auto* const header = std::get_if<journal::Header>(&*unwritten_);
    if (header == nullptr && !has_segment_) {
        unwritten_.reset();
        return;
    }
    if (header != nullptr) {
        on_disk([&] { writer_.begin_segment(*header); });
        has_segment_ = true;
    } else {
        // With a clock reading later than the reader's own, the header would include later sleeps.
        const auto* const reading = std::get_if<timing::ClockReading>(&*unwritten_);
        std::optional<journal::Header> rotated;
        on_disk([&] { rotated = writer_.append(*unwritten_, reading ? *reading : clock_.read()); });
        if (rotated) hand_over(*rotated);  // The archive must see the same chunks as a reader.
    }
    is_dirty_ = true;
    hand_over(*std::exchange(unwritten_, std::nullopt));
    const std::lock_guard lock(mutex_);
    status_.is_faulty = false;
    status_.bytes_written = writer_.bytes_written();
}

void JournalThread::hand_over(journal::Chunk chunk) {
    if (written_.push({++last_chunk_, std::move(chunk)})) return;
    const std::lock_guard lock(mutex_);
    ++status_.archive_waits;
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
        post(journal::EventChunk{events::to_json(commit.event)});
        if (may_try_again()) {
            retry_unwritten();
            while (auto chunk = take_first(posted_)) write(std::move(*chunk));
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
    faults_running_ = 0;
    {
        const std::lock_guard lock(mutex_);
        status_.is_faulty = false;
    }
    progress_.journal_synced(last_chunk_);
}

/// Runs a disk operation and measures its time.  If the disk is full, gives up the reserve and
/// tries once more.
void JournalThread::on_disk(const std::function<void()>& operation) {
    {
        const std::lock_guard lock(mutex_);
        on_disk_since_ = time_.now();
    }
    const struct Measurement {
        JournalThread& thread;
        ~Measurement() {
            const std::lock_guard lock(thread.mutex_);
            const auto took = thread.time_.now() - *thread.on_disk_since_;
            thread.on_disk_since_.reset();
            auto& longest = thread.status_.longest_sync;
            longest = std::max(longest, std::chrono::duration_cast<milliseconds>(took));
        }
    } measurement{*this};
    try {
        operation();
    } catch (const std::system_error& error) {
        if (!files::is_disk_full(error.code()) || !reserve_.give_up()) throw;
        operation();
    }
}

void JournalThread::note_fault(const std::string& trouble) {
    ++faults_running_;
    const std::lock_guard lock(mutex_);
    last_fault_ = time_.now();
    status_.is_faulty = true;
    status_.trouble = trouble;
    ++status_.faults;
}

// Tries again at once after the first fault, then at intervals: each try may begin a segment.
bool JournalThread::may_try_again() const {
    if (faults_running_ < 2) return true;
    const std::lock_guard lock(mutex_);
    return phase_ != Phase::running || !is_fault_recent();
}

/// Must be called with the lock held.
bool JournalThread::is_fault_recent() const {
    return last_fault_ && time_.now() - *last_fault_ < time_.retry_interval;
}

}  // namespace a351::daemon::store
