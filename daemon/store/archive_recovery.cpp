#include "daemon/store/archive_recovery.hpp"

#include <exception>
#include <memory>
#include <utility>

namespace a351::daemon::store {

ArchiveRecovery::ArchiveRecovery(files::FileLayer& files, const archive::RecoveryPlan& plan,
                                 const Options& options, const SpaceReserve& reserve,
                                 JournalKeeper& keeper, WaitingRecords& records, Decoder& decoder,
                                 RecordWriter& writer, ArchiveHealth& health,
                                 const std::atomic<bool>& is_hurried)
    : files_(files),
      plan_(plan),
      options_(options),
      reserve_(reserve),
      keeper_(keeper),
      records_(records),
      decoder_(decoder),
      writer_(writer),
      health_(health),
      is_hurried_(is_hurried),
      retry_(0, options.time) {}

bool ArchiveRecovery::advance() noexcept {
    if (is_done_) return true;
    if (!retry_.may_try(options_.time.now())) return false;
    archive::RecoveryReport report;
    try {
        report.journal = plan_.cut;
        if (!replay(report)) return false;
        options_.recovered(report);
    } catch (const std::exception& error) {
        // After a failed sync it is not known which data the kernel kept and which it dropped.
        health_.end_marks();
        note_fault(error.what());
        return false;
    }
    if (report.chunks_lost > 0) health_.end_marks();
    health_.note_success();
    keeper_.keep_names(false);
    is_done_ = true;
    return true;
}

void ArchiveRecovery::note_fault(const std::string& trouble) {
    health_.note_fault(trouble);
    retry_.note_failure(options_.time.now());
}

/// @return false if the daemon is stopping, or if the remaining space is needed for the journal.
bool ArchiveRecovery::replay(archive::RecoveryReport& report) {
    while (records_.pop()) {  // Left by a try before.
    }
    decoder_.begin_replay();
    const auto root = options_.root / "archive";
    const journal::StationCodes& codes = options_.station.codes;
    std::unique_ptr<archive::Writer> archive;
    for (const archive::Replay& part : plan_.replays) {
        archive = std::make_unique<archive::Writer>(files_, root, part.codes);
        decoder_.replay_into(*archive);
        const auto take_chunk = [&](const journal::Chunk& chunk) { return take(chunk, *archive); };
        if (!archive::replay_journal(files_, root, part, *archive, take_chunk, report))
            return false;
        const bool continues = &part == &plan_.replays.back() && part.codes == codes;
        if (!continues) {
            decoder_.close_records();
            write_records(*archive);
            archive->settle();
        }
        // No mark is written yet.  If the session continues, its first records bring the mark.
        static_cast<void>(archive->sync());
        if (!continues) archive = std::make_unique<archive::Writer>(files_, root, codes);
    }
    if (!archive) archive = std::make_unique<archive::Writer>(files_, root, codes);
    const auto session = decoder_.end_replay(archive->held());
    writer_.begin(std::move(archive), session);
    return true;
}

bool ArchiveRecovery::take(const journal::Chunk& chunk, archive::Writer& archive) {
    if (is_hurried_) return false;
    if (reserve_.is_space_short()) {
        note_fault("the remaining space is kept for the journal");
        return false;
    }
    const bool begins_session = decoder_.replay(chunk);
    write_records(archive);
    if (begins_session) archive.begin_session();
    return true;
}

void ArchiveRecovery::write_records(archive::Writer& archive) {
    while (const auto waiting = records_.pop())
        archive.record(waiting->channel, waiting->record, waiting->last_index);
}

}  // namespace a351::daemon::store
