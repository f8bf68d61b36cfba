#include "protocol/archive/recovery.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"

namespace a351::archive {
namespace {

/// Returns the time up to which a channel is certainly on disk; std::nullopt if the mark does not
/// name the channel: its records may come from sessions that are not replayed.
std::optional<UtcTime> synced_until(const Replay& replay, const std::string& channel) {
    if (!replay.mark) return UtcTime::min();
    for (const journal::ChannelMark& mark : replay.mark->channels)
        if (mark.channel == channel) return mark.utc;
    return std::nullopt;
}

std::vector<Replay> plan_replays(const std::filesystem::path& journal) {
    std::vector<Replay> replays;  // newest first
    std::optional<journal::MarkChunk> mark;
    bool has_reached_oldest = false;
    const auto segments = journal::segment_files(journal);
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
        const auto header = journal::segment_header(*segment);
        if (!header) continue;  // nothing in it can be read
        if (has_reached_oldest && header->session != mark->session) break;
        if (replays.empty() || header->codes != replays.back().codes)
            replays.push_back({.segments = {}, .codes = header->codes, .mark = {}});
        replays.back().segments.push_back(*segment);
        if (!mark) mark = journal::newest_mark(*segment);
        has_reached_oldest = mark && header->session == mark->session;
        if (has_reached_oldest) replays.back().mark = mark;
    }
    for (Replay& replay : replays) std::reverse(replay.segments.begin(), replay.segments.end());
    std::reverse(replays.begin(), replays.end());
    return replays;
}

}  // namespace

RecoveryPlan begin_recovery(files::FileLayer& files, const std::filesystem::path& journal) {
    auto cut = journal::repair_newest_segment(files, journal);
    return {plan_replays(journal), std::move(cut)};
}

bool replay_journal(files::FileLayer& files, const std::filesystem::path& archive,
                    const Replay& replay, Writer& writer,
                    const std::function<bool(const journal::Chunk&)>& take,
                    RecoveryReport& report) {
    for (const auto& channel : channels_in(archive, replay.codes)) {
        for (const auto& day_file : recent_day_files(archive, replay.codes, channel)) {
            const auto tail = repair_tail(files, day_file, side_directory(archive),
                                          synced_until(replay, channel));
            if (tail) report.archive.push_back(*tail);
        }
    }

    writer.begin_replay();
    journal::Sequence chunks(replay.segments);
    while (const auto chunk = chunks.next()) {
        try {
            if (!take(*chunk)) return false;
        } catch (const InputError&) {
            ++report.chunks_lost;
        }
    }
    report.damage.insert(report.damage.end(), chunks.damage().begin(), chunks.damage().end());
    writer.settle();
    report.records_added += writer.records_written();
    report.records_confirmed += writer.records_skipped();
    report.records_conflicting += writer.replay_conflicts();
    return true;
}

}  // namespace a351::archive
