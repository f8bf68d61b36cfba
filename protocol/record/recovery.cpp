#include "protocol/record/recovery.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"

namespace a351::record {
namespace {

// Records may be older than the header's clock by the filter's delay, and the day file is read
// whole anyway.
constexpr auto kMargin = std::chrono::hours(1);

/// Instant of the newest sample of a channel that survived whatever happened; std::nullopt when the
/// mark does not speak of it: what stands there may come from sessions that are not replayed.
std::optional<UtcTime> synced_until(const Replay& replay, const std::string& channel) {
    if (!replay.mark) return UtcTime::min();
    for (const ChannelMark& mark : replay.mark->channels)
        if (mark.channel == channel) return mark.utc;
    return std::nullopt;
}

Replay plan_replay(const std::filesystem::path& journal) {
    Replay replay;
    bool has_reached_oldest = false;
    const auto segments = journal_segments(journal);
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
        const auto header = segment_header(*segment);
        if (!header) continue;  // nothing in it can be read
        if (has_reached_oldest && header->session != replay.mark->session) break;
        if (replay.segments.empty()) replay.codes = header->codes;
        // What stands under other codes was recovered at the start that brought the new ones.
        if (header->codes != replay.codes) break;
        replay.segments.push_back(*segment);
        replay.earliest = std::min(replay.earliest, header->clock.realtime);
        if (!replay.mark) replay.mark = newest_mark(*segment);
        has_reached_oldest = replay.mark && header->session == replay.mark->session;
    }
    std::reverse(replay.segments.begin(), replay.segments.end());
    return replay;
}

}  // namespace

Replay begin_recovery(FileLayer& files, const std::filesystem::path& journal) {
    auto cut = repair_newest_segment(files, journal);
    Replay replay = plan_replay(journal);
    replay.cut = std::move(cut);
    return replay;
}

bool replay_journal(FileLayer& files, const std::filesystem::path& archive, const Replay& replay,
                    ArchiveWriter& writer, const std::function<bool(const JournalChunk&)>& take,
                    RecoveryReport& report) {
    report = {};
    report.journal = replay.cut;
    if (replay.segments.empty()) return true;
    for (const auto& channel : channels_in(archive, replay.codes)) {
        const auto day_file = newest_day_file(archive, replay.codes, channel);
        if (!day_file) continue;
        const auto tail = repair_tail(files, *day_file, synced_until(replay, channel));
        if (tail) report.archive.push_back(*tail);
    }

    writer.begin_replay(replay.earliest - kMargin);
    JournalSequence chunks(replay.segments);
    while (const auto chunk = chunks.next()) {
        try {
            if (!take(*chunk)) return false;
        } catch (const InputError&) {
            ++report.chunks_lost;
        }
    }
    report.records_added = writer.records_written();
    report.records_confirmed = writer.records_passed_over();
    report.records_conflicting = writer.replay_conflicts();
    return true;
}

}  // namespace a351::record
