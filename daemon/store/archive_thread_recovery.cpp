/// @file
/// The begin of the decoding thread: it adds the data that the last run left in the journal.

#include "daemon/store/archive_thread.hpp"

namespace a351::daemon::store {

/// Adds the last run's journal to the archive.  The archiver is then in the state in which that run
/// ended, so that an adopted stream continues its session.
/// @return false if the disk failed, or the daemon is stopping; must be called again.
bool ArchiveThread::recover() noexcept {
    {
        const std::lock_guard lock(mutex_);
        if (!status_.is_replaying) return true;
    }
    if (!retry_.may_try(time_.now())) return false;
    archive::RecoveryReport report;
    try {
        report.journal = plan_.cut;
        if (!replay(report)) return false;
        hooks_.recovered(report);
    } catch (const std::exception& error) {
        // After a failed sync it is not known which data the kernel kept and which it dropped.
        are_marks_true_ = false;
        note_fault(error.what());
        retry_.note_failure(time_.now());
        return false;
    }
    retry_.note_success();
    if (report.chunks_lost > 0) are_marks_true_ = false;
    const std::lock_guard lock(mutex_);
    status_.counters = archiver_->counters();
    status_.trouble.clear();
    status_.is_replaying = false;
    return true;
}

bool ArchiveThread::replay(archive::RecoveryReport& report) {
    {
        const std::lock_guard lock(mutex_);
        open_archive(codes_);
        outbox_.entries.clear();
        outbox_.bytes = 0;
        archiver_ = std::make_unique<archive::Archiver>(outbox_);
        session_.reset();
        ended_.clear();
    }
    const auto take = [this](const journal::Chunk& chunk) { return replay_chunk(chunk); };
    for (const archive::Replay& part : plan_.replays) {
        {
            const std::lock_guard lock(mutex_);
            open_archive(part.codes);
        }
        if (!archive::replay_journal(files_, archive_, part, *writer_, take, report)) return false;
        if (&part == &plan_.replays.back() && part.codes == codes_) break;
        // Nothing continues in a part with other station codes.
        std::unique_lock lock(mutex_);
        archiver_->close_records();
        lock.unlock();
        write_replayed();
        writer_->settle();
        static_cast<void>(writer_->sync());
    }
    // No mark is written yet.  If a session continues, its first records bring the mark.
    static_cast<void>(writer_->sync());
    const std::lock_guard lock(mutex_);
    outbox_.session = marked_ = session_;
    if (!plan_.replays.empty() && plan_.replays.back().codes != codes_) open_archive(codes_);
    outbox_.held = writer_->held();
    outbox_.writer = nullptr;  // From here on only the writing thread uses it.
    return true;
}

void ArchiveThread::open_archive(const journal::StationCodes& codes) {
    writer_ = std::make_unique<archive::Writer>(files_, archive_, codes);
    outbox_.writer = writer_.get();
}

/// Processes one chunk of the replay.
/// @return false if the daemon is stopping, or the remaining space is the journal's.
bool ArchiveThread::replay_chunk(const journal::Chunk& chunk) {
    if (reserve_.is_space_short()) {
        note_fault("the remaining space is kept for the journal");
        retry_.note_failure(time_.now());
        return false;
    }
    bool is_new_session = false;
    {
        const std::lock_guard lock(mutex_);
        if (is_hurried_) return false;
        if (const auto* const header = std::get_if<journal::Header>(&chunk)) {
            is_new_session = header->session != session_;
            note_session(header->session);
        }
        archiver_->take(chunk);
    }
    write_replayed();
    if (is_new_session) writer_->begin_session();
    return true;
}

void ArchiveThread::write_replayed() {
    for (const Outbox::Entry& entry : outbox_.entries)
        writer_->record(entry.channel, entry.record, entry.last_index);
    outbox_.entries.clear();
    outbox_.bytes = 0;
}

}  // namespace a351::daemon::store
