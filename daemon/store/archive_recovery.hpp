#pragma once

#include <atomic>
#include <string>

#include "daemon/store/archive_health.hpp"
#include "daemon/store/decoder.hpp"
#include "daemon/store/options.hpp"
#include "daemon/store/record_writer.hpp"
#include "protocol/archive/recovery.hpp"

namespace a351::daemon::store {

/// Adds the journal of the last run to the archive.  The decoder is then in the state in which that
/// run ended, so that an adopted stream continues its session.
///
/// For the thread that decodes, before anything else; it waits for the disk.  Only is_done() may be
/// called by any thread.
class ArchiveRecovery {
public:
    /// All objects passed by reference must outlive this.
    /// @param is_hurried  leaves the rest of the replay to the next start.
    ArchiveRecovery(files::FileLayer& files, const archive::RecoveryPlan& plan,
                    const Options& options, const SpaceReserve& reserve, JournalKeeper& keeper,
                    WaitingRecords& records, Decoder& decoder, RecordWriter& writer,
                    ArchiveHealth& health, const std::atomic<bool>& is_hurried);

    /// @return false if the disk failed or has no space for it, or the daemon is stopping; must be
    /// called again.
    [[nodiscard]] bool advance() noexcept;

    [[nodiscard]] bool is_done() const noexcept { return is_done_; }

private:
    [[nodiscard]] bool replay(archive::RecoveryReport& report);
    [[nodiscard]] bool take(const journal::Chunk& chunk, archive::Writer& archive);
    void write_records(archive::Writer& archive);
    void note_fault(const std::string& trouble);

    files::FileLayer& files_;
    const archive::RecoveryPlan& plan_;
    const Options& options_;
    const SpaceReserve& reserve_;
    JournalKeeper& keeper_;
    WaitingRecords& records_;
    Decoder& decoder_;
    RecordWriter& writer_;
    ArchiveHealth& health_;
    const std::atomic<bool>& is_hurried_;
    Retry retry_;
    std::atomic<bool> is_done_{false};
};

}  // namespace a351::daemon::store
