#include "daemon/status/recovery_log.hpp"

#include <spdlog/spdlog.h>

namespace a351::daemon::status {

void log_recovery(spdlog::logger& log, const archive::RecoveryReport& report) {
    if (report.journal) {
        log.warn("recovery: {} bytes removed from {} from offset {} on: {}",
                 report.journal->byte_count, report.journal->file.string(), report.journal->offset,
                 report.journal->reason);
    }
    for (const journal::Damage& damage : report.damage) {
        log.error("recovery: {} bytes of {} at offset {} are damaged and skipped: {}",
                  damage.byte_count, damage.file.string(), damage.offset, damage.reason);
    }
    for (const archive::TornTail& tail : report.archive) {
        log.warn("recovery: {} bytes removed from {} from offset {} on", tail.byte_count,
                 tail.file.string(), tail.offset);
    }
    log.info("recovery: {} records added to the archive, {} were already there",
             report.records_added, report.records_confirmed);
    if (report.chunks_lost > 0) {
        log.error(
            "recovery: {} chunks of the journal could not be processed and are missing from the "
            "archive",
            report.chunks_lost);
    }
    if (report.records_conflicting > 0) {
        log.error(
            "recovery: {} records of the archive differ from the journal; those of the archive are "
            "kept",
            report.records_conflicting);
    }
}

}  // namespace a351::daemon::status
