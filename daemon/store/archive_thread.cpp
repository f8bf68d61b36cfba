#include "daemon/store/archive_thread.hpp"

#include <exception>
#include <variant>

namespace a351::daemon::store {
namespace {

constexpr std::chrono::milliseconds kWriteInterval{250};

}  // namespace

ArchiveThread::ArchiveThread(files::FileLayer& files, const Options& options,
                             const source::HostClock& clock, ChunkQueue& chunks, Progress& progress,
                             SpaceReserve& reserve, JournalThread& journal, JournalKeeper& keeper,
                             const archive::RecoveryPlan& plan)
    : options_(options),
      chunks_(chunks),
      reserve_(reserve),
      records_(progress, options.waiting_records_bytes),
      metadata_(files, options.root, options.station),
      decoder_(options, clock, records_, progress, journal),
      writer_(files, options, records_, progress, reserve, journal, metadata_, health_),
      recovery_(files, plan, options, reserve, keeper, records_, decoder_, writer_, health_,
                is_hurried_) {}

ArchiveThread::~ArchiveThread() {
    if (!thread_.joinable()) return;
    chunks_.close();
    skip_waits();
    join();
}

void ArchiveThread::start() {
    thread_ = std::thread([this] { run(); });
    writing_thread_ = std::thread([this] { run_writing(); });
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
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
        changed_.notify_all();
    }
    if (is_started)
        writing_thread_.join();
    else
        run_writing();
    const ArchiveHealth::Status health = health_.status();
    return health.trouble.empty() && health.chunks_lost == 0;
}

void ArchiveThread::run() noexcept {
    options_.begin();
    NumberedChunk numbered;
    while (!recovery_.advance()) {
        const bool is_over = wait(options_.time.retry_interval, is_hurried_);
        if (!is_over && !chunks_.is_half_full()) continue;
        if (!is_over) {
            health_.note_fault(
                "adding the last run's data was given up until the next start, so that the "
                "journal need not wait");
        }
        while (chunks_.pop(numbered)) {  // Dropped; the next start finds them in the journal.
        }
        return;
    }
    while (chunks_.pop(numbered)) {
        handle(numbered);
        wait_for_room();
    }
    decoder_.end_run();
}

void ArchiveThread::run_writing() noexcept {
    while (!wait(kWriteInterval, is_ending_)) {
        look_at_space();
        if (recovery_.is_done()) writer_.write();
    }
    if (recovery_.is_done()) writer_.finish();
}

void ArchiveThread::step() {
    look_at_space();
    if (!recovery_.advance()) return;
    NumberedChunk numbered;
    while (chunks_.try_pop(numbered)) handle(numbered);
    writer_.write();
}

void ArchiveThread::handle(const NumberedChunk& numbered) noexcept {
    try {
        if (const auto* const header = std::get_if<journal::Header>(&numbered.chunk))
            metadata_.note(*header);
        decoder_.take(numbered);
    } catch (const std::exception& error) {
        health_.note_fault(error.what());
        health_.note_loss(&ArchiveHealth::Status::chunks_lost);
    }
}

/// Waits while the records that are being written fill the memory, and drops those that cannot be
/// written.
void ArchiveThread::wait_for_room() {
    while (records_.is_full() && !is_hurried_) {
        if (records_.drop_unwritable(!health_.status().trouble.empty()))
            health_.note_loss(&ArchiveHealth::Status::records_dropped);
        else
            wait(kWriteInterval, is_hurried_);
    }
}

/// Looks at the free space, whatever the archive does: the reserve is the journal's.
void ArchiveThread::look_at_space() {
    const SteadyTime now = options_.time.now();
    if (now - last_look_at_space_ < kSpaceInterval) return;
    last_look_at_space_ = now;
    reserve_.tend();
}

/// @return true if `is_over` became true within that time.
bool ArchiveThread::wait(std::chrono::milliseconds longest, const std::atomic<bool>& is_over) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, longest, [&] { return is_over.load(); });
}

std::optional<survey::Instant> ArchiveThread::latest() const {
    return recovery_.is_done() ? decoder_.latest() : std::nullopt;
}

std::optional<survey::Instant> ArchiveThread::at(UtcTime utc) const {
    return recovery_.is_done() ? decoder_.at(utc) : std::nullopt;
}

Nanoseconds ArchiveThread::signal_since(const journal::SessionId& session,
                                        std::int64_t index) const {
    return recovery_.is_done() ? decoder_.signal_since(session, index) : Nanoseconds(0);
}

ArchiveStatus ArchiveThread::status() const {
    return {health_.status(),     decoder_.status(), writer_.status(),
            !recovery_.is_done(), records_.count(),  metadata_.trouble()};
}

}  // namespace a351::daemon::store
