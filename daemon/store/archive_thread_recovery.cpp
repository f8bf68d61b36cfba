/// @file
/// The beginning of the archive thread: what the last run left in the journal.

#include <system_error>

#include "daemon/store/archive_thread.hpp"

namespace a351::daemon {

/// Brings the last run's journal in.  The archiver then stands where that run left it: a stream
/// that is adopted goes on in its session.
/// @return false: the disk failed, or time was short; to be called again.
bool ArchiveThread::recover() noexcept {
    {
        const std::lock_guard lock(mutex_);
        if (!status_.is_replaying) return true;
    }
    if (retry_at_ && time_.now() < *retry_at_) return false;
    record::RecoveryReport report;
    reserve_.tend();
    try {
        report.journal = plan_.cut;
        if (!replay(report)) return false;
        hooks_.recovered(report);
    } catch (const std::exception& error) {
        // What the kernel dropped after a failed sync cannot be told from what it kept.
        const auto* const failure = dynamic_cast<const std::system_error*>(&error);
        if (failure == nullptr || !record::is_disk_full(failure->code())) are_marks_true_ = false;
        note_fault(error.what());
        retry_at_ = time_.now() + time_.retry_interval;
        return false;
    }
    retry_at_.reset();
    if (report.chunks_lost > 0) are_marks_true_ = false;
    const std::lock_guard lock(mutex_);
    status_.counters = archiver_->counters();
    status_.is_faulty = false;
    status_.is_replaying = false;
    return true;
}

bool ArchiveThread::replay(record::RecoveryReport& report) {
    {
        const std::lock_guard lock(mutex_);
        open_archive(codes_);
        outbox_.entries.clear();
        outbox_.bytes = 0;
        archiver_ = std::make_unique<record::Archiver>(outbox_);
        session_.reset();
        ended_.clear();
    }
    const auto take = [this](const record::JournalChunk& chunk) { return take_again(chunk); };
    for (const record::Replay& part : plan_.replays) {
        {
            const std::lock_guard lock(mutex_);
            open_archive(part.codes);
        }
        if (!record::replay_journal(files_, archive_, part, *writer_, take, report)) return false;
        if (&part != &plan_.replays.back() || part.codes != codes_) close_replayed();
    }
    // No mark yet where nothing goes on; it is with the first records of the session that does.
    static_cast<void>(writer_->sync());
    const std::lock_guard lock(mutex_);
    outbox_.session = marked_ = session_;
    if (plan_.replays.empty() || plan_.replays.back().codes == codes_) return true;
    open_archive(codes_);
    return true;
}

/// Other codes are another archive: nothing can go on there.
void ArchiveThread::close_replayed() {
    {
        const std::lock_guard lock(mutex_);
        archiver_->close_records();
    }
    write_replayed();
    static_cast<void>(writer_->sync());
}

void ArchiveThread::open_archive(const record::StationCodes& codes) {
    writer_ = std::make_unique<record::ArchiveWriter>(files_, archive_, codes);
    outbox_.writer = writer_.get();
}

/// @return false when time is short.
bool ArchiveThread::take_again(const record::JournalChunk& chunk) {
    if (reserve_.is_space_short())
        throw std::system_error(std::make_error_code(std::errc::no_space_on_device),
                                "the journal needs the space");
    bool is_new_session = false;
    {
        const std::lock_guard lock(mutex_);
        if (is_hurried_) return false;
        if (const auto* const header = std::get_if<record::JournalHeader>(&chunk)) {
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

}  // namespace a351::daemon
