#include "daemon/store/record_writer.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::daemon::store {
namespace {

constexpr std::chrono::seconds kArchiveSyncInterval{30};

}  // namespace

RecordWriter::RecordWriter(files::FileLayer& files, const Options& options, WaitingRecords& records,
                           Progress& progress, const SpaceReserve& reserve, JournalThread& journal,
                           StationMetadata& metadata, ArchiveHealth& health)
    : files_(files),
      options_(options),
      records_(records),
      progress_(progress),
      reserve_(reserve),
      journal_(journal),
      metadata_(metadata),
      health_(health),
      last_sync_(options.time.now()),
      retry_(0, options.time) {}

void RecordWriter::begin(std::unique_ptr<archive::Writer> archive,
                         const std::optional<journal::SessionId>& session) {
    archive_ = std::move(archive);
    marked_ = session;
}

bool RecordWriter::may_write() const {
    return may_archive(reserve_.is_space_short(), records_.is_full());
}

void RecordWriter::write() {
    if (may_write() && retry_.may_try(options_.time.now())) try_to_write(false);
}

void RecordWriter::finish() {
    if (!try_to_write(true)) try_to_write(true);
}

/// @return false if the disk failed; the rest waits.
bool RecordWriter::try_to_write(bool is_last) {
    try {
        if (retry_.is_failing()) repair();
        metadata_.write();
        write_waiting(is_last);
        if (is_last || options_.time.now() - last_sync_ >= kArchiveSyncInterval) sync();
    } catch (const std::exception& error) {
        health_.note_fault(error.what());
        retry_.note_failure(options_.time.now());
        return false;
    }
    retry_.note_success();
    health_.note_success();
    return true;
}

void RecordWriter::write_waiting(bool is_last) {
    while (is_last || may_write()) {
        auto waiting = records_.pop();
        if (!waiting) break;
        try {
            write_record(*waiting);
        } catch (...) {
            records_.put_back(std::move(*waiting));
            throw;
        }
        ++written_;
    }
    // The replay is over, so that no later match helps to decide.
    archive_->settle();
    conflicts_ = archive_->replay_conflicts();
}

void RecordWriter::write_record(const WaitingRecord& waiting) {
    if (waiting.session != marked_) {  // Marks never mix sessions.
        archive_
            ->settle();  // The last session's records must be synced before the next one's mark.
        if (marked_) sync();
        archive_->end_replay();
        archive_->begin_session();
        marked_ = waiting.session;
    }
    archive_->record(waiting.channel, waiting.record, waiting.last_index);
}

void RecordWriter::sync() {
    last_sync_ = options_.time.now();
    std::vector<journal::ChannelMark> marks;
    try {
        marks = archive_->sync();
    } catch (...) {
        // It is not known which data the kernel kept and which it dropped.
        health_.end_marks();
        throw;
    }
    if (!marked_ || marks.empty() || !health_.status().is_marking) return;
    std::optional<std::int64_t> last;
    for (const auto& mark : marks) {
        if (archive::is_derived(mark.channel)) continue;
        last = std::min(last.value_or(mark.index), mark.index);
    }
    if (last) progress_.archive_synced(*marked_, *last);
    journal_.push(0, journal::MarkChunk{*marked_, std::move(marks)});
}

/// Repairs and opens the archive after a fault, which may have left an incomplete record at the end
/// of a day file; nothing may be appended after that.
void RecordWriter::repair() {
    if (health_.status().is_marking) {
        try {
            static_cast<void>(archive_->sync());
        } catch (const std::system_error&) {
            health_.end_marks();
        }
    }
    const auto archive = options_.root / "archive";
    const journal::StationCodes& codes = options_.station.codes;
    for (const std::string& channel : archive::channels_in(archive, codes))
        for (const auto& file : archive::recent_day_files(archive, codes, channel))
            archive::repair_tail(files_, file, archive::side_directory(archive));
    archive_->reopen();
}

}  // namespace a351::daemon::store
