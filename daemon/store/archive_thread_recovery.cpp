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
        if (!replay(report)) return false;
    } catch (const std::exception& error) {
        note_fault(error.what());
        retry_at_ = time_.now() + time_.retry_interval;
        return false;
    }
    retry_at_.reset();
    if (report.chunks_lost > 0) are_marks_true_ = false;
    hooks_.recovered(report);
    const std::lock_guard lock(mutex_);
    status_.counters = archiver_->counters();
    status_.is_faulty = false;
    status_.is_replaying = false;
    return true;
}

bool ArchiveThread::replay(record::RecoveryReport& report) {
    {
        const std::lock_guard lock(mutex_);
        open_archive(replay_.codes);
        outbox_.entries.clear();
        archiver_ = std::make_unique<record::Archiver>(outbox_);
        session_.reset();
        ended_.clear();
    }
    const auto take = [this](const record::JournalChunk& chunk) { return take_again(chunk); };
    if (!record::replay_journal(files_, archive_, replay_, *writer_, take, report)) return false;
    const bool is_other_archive = replay_.codes != codes_;
    {
        const std::lock_guard lock(mutex_);
        outbox_.session = marked_ = session_;
        if (is_other_archive) archiver_->close_records();  // Nothing can go on there.
    }
    if (!is_other_archive) return true;
    write_replayed();
    static_cast<void>(writer_->sync());
    const std::lock_guard lock(mutex_);
    open_archive(codes_);
    return true;
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
