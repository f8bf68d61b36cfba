#include "protocol/archive/journal_tail.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>

#include "protocol/archive/archiver.hpp"
#include "protocol/archive/record_joiner.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::archive {
namespace {

namespace fs = std::filesystem;

// Data before the tail from which its times come, s.  Source: the window of ArrivalEdge.
constexpr std::chrono::minutes kWarmUp(15);
// Data read beyond the end, so that the clock readings around the last sample are included.
constexpr std::chrono::seconds kBeyond(10);
// Archived samples that are searched for in the tail.  Reason: noise does not repeat two seconds.
constexpr std::size_t kComparedSamples = 100;
// Largest difference between the tail's times and those of the archive.  Reason: without a clock
// reading in error it is below a millisecond.
constexpr std::chrono::milliseconds kMostShift(500);

/// Part of a journal to read.
struct Part {
    std::vector<fs::path> segments;  ///< The oldest first.
    UtcTime begin;                   ///< Bytes that arrived before are skipped.
};

/// Returns the segments, beginning with the last one that began before `from - kWarmUp`.  If its
/// session began at most `longest_session` before `from`, they begin with the first one of the
/// session.
Part part_since(const fs::path& journal, UtcTime from, Nanoseconds longest_session) {
    std::vector<fs::path> segments = journal::segment_files(journal);
    const UtcTime begin = from - kWarmUp;
    auto first = segments.end(), of_session = segments.end();
    std::optional<journal::SessionId> session;
    while (of_session != segments.begin()) {
        const auto header = journal::segment_header(*std::prev(of_session));
        if (session && header && header->session != *session)
            return {{of_session, segments.end()}, UtcTime::min()};
        --of_session;
        if (!session) first = of_session;
        if (!header || header->clock.realtime > begin) continue;
        session = header->session;
        if (header->clock.realtime < from - longest_session)
            return {{first, segments.end()}, begin};
    }
    return {std::move(segments), UtcTime::min()};
}

/// Returns the index of the sample of `tail` that is the last one of `archived`.
std::optional<std::size_t> find_last(const Segment& archived, const Segment& tail) {
    const std::size_t count = archived.counts.size();
    if (count < kComparedSamples || tail.counts.size() < kComparedSamples) return std::nullopt;
    const auto wanted = archived.counts.end() - kComparedSamples;
    const double ahead_s = seconds_between(tail.time_of(0), archived.time_of(count - 1));
    const auto near = static_cast<std::ptrdiff_t>(std::llround(ahead_s * tail.rate_hz));
    const auto reach = static_cast<std::ptrdiff_t>(
        std::chrono::duration<double>(kMostShift).count() * tail.rate_hz);
    for (std::ptrdiff_t k = 0; k <= 2 * reach; ++k) {
        const std::ptrdiff_t at = near + (k % 2 == 0 ? k / 2 : -(k + 1) / 2);
        if (at + 1 < static_cast<std::ptrdiff_t>(kComparedSamples) ||
            at >= static_cast<std::ptrdiff_t>(tail.counts.size()))
            continue;
        if (std::equal(wanted, archived.counts.end(),
                       tail.counts.begin() + at + 1 - kComparedSamples))
            return static_cast<std::size_t>(at);
    }
    return std::nullopt;
}

/// Returns the samples of a segment from `first` on as a record, with the time flags of its anchor.
DecodedRecord record_from(const Segment& segment, const Segment::Anchor& anchor, std::size_t first,
                          std::size_t end, Nanoseconds shift) {
    DecodedRecord record;
    record.header.nominal_rate = Hertz(segment.rate_hz);
    record.header.start = segment.time_of(first) + shift;
    record.header.is_time_questionable = anchor.is_time_questionable;
    record.header.timing_quality_percent = anchor.timing_quality_percent;
    record.samples.assign(segment.counts.begin() + static_cast<std::ptrdiff_t>(first),
                          segment.counts.begin() + static_cast<std::ptrdiff_t>(end));
    return record;
}

/// Appends the samples of a segment from `first` on, with a time stamp wherever it has one.
void append(RecordJoiner& joiner, const Segment& segment, std::size_t first, Nanoseconds shift) {
    for (std::size_t k = 0; k < segment.anchors.size(); ++k) {
        const std::size_t end =
            k + 1 < segment.anchors.size() ? segment.anchors[k + 1].offset : segment.counts.size();
        if (end <= first) continue;
        const Segment::Anchor& anchor = segment.anchors[k];
        joiner.take(record_from(segment, anchor, std::max(first, anchor.offset), end, shift));
    }
}

}  // namespace

struct JournalTail::Gather final : Sink {
    Gather(JournalTail& tail_, const journal::StationCodes& codes_, UtcTime kept_from_)
        : tail(tail_), codes(codes_), kept_from(kept_from_) {}

    void record(const std::string& channel, const PackedRecord& packed, std::int64_t) override {
        const auto record = decode_record(packed.bytes);
        if (!record || !is_of(codes, record->header)) return;
        const double length_s = static_cast<double>(record->samples.size()) / record->rate_hz();
        if (record->header.start + from_seconds(length_s) < kept_from) return;
        RecordJoiner(tail.channels_[channel][run], UtcTime::min(), UtcTime::max()).take(*record);
    }

    JournalTail& tail;
    const journal::StationCodes& codes;
    UtcTime kept_from;  ///< Records that end before are not kept.
    std::uint64_t run = 0;
};

std::optional<UtcTime> journal_end(const fs::path& journal) {
    const auto segments = journal::segment_files(journal);
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
        std::optional<UtcTime> newest;
        journal::Reader reader(*segment);
        while (const auto chunk = reader.next()) {
            if (const auto* header = std::get_if<journal::Header>(&*chunk))
                newest = header->clock.realtime;
            else if (const auto* reading = std::get_if<timing::ClockReading>(&*chunk))
                newest = reading->realtime;
        }
        if (newest) return newest;
    }
    return std::nullopt;
}

JournalTail::JournalTail(const fs::path& journal, const journal::StationCodes& codes, UtcTime from,
                         UtcTime to, Nanoseconds longest_session) {
    const auto [segments, begin] = part_since(journal, from, longest_session);
    Gather gather(*this, codes, from - kWarmUp);
    Archiver archiver(gather);
    journal::Sequence chunks(segments);
    Nanoseconds raw_to_utc{0};
    bool is_at_part = false;  // A clock that is ahead at the start and set back later is no end.
    while (const auto chunk = chunks.next()) {
        const timing::ClockReading* reading = std::get_if<timing::ClockReading>(&*chunk);
        if (const auto* header = std::get_if<journal::Header>(&*chunk)) reading = &header->clock;
        if (reading != nullptr) {
            raw_to_utc = reading->realtime.time_since_epoch() - reading->raw.time_since_epoch();
            const bool is_beyond = reading->realtime > to + kBeyond;
            end_ = reading->realtime;
            if (is_beyond && is_at_part) {
                end_.reset();
                break;
            }
            is_at_part = is_at_part || !is_beyond;
        }
        if (const auto* received = std::get_if<journal::RxChunk>(&*chunk);
            received != nullptr && !received->reads.empty() &&
            UtcTime(received->reads.back().time.time_since_epoch() + raw_to_utc) < begin)
            continue;
        try {
            archiver.take(*chunk);
        } catch (const InputError&) {
            continue;  // settings that this program does not know
        }
        gather.run = archiver.counters().sessions;
    }
    archiver.close_records();
}

void JournalTail::append_to(ChannelData& data, const std::string& channel, UtcTime from,
                            UtcTime to) const {
    const auto found = channels_.find(channel);
    if (found == channels_.end()) return;
    const Runs& runs = found->second;
    UtcTime after = from;
    auto run = runs.begin();
    std::size_t segment = 0, first = 0;
    Nanoseconds shift{0};
    if (!data.segments.empty()) {
        const Segment& last = data.segments.back();
        const UtcTime last_time = last.time_of(last.counts.size() - 1);
        after = std::max(from, last_time + from_seconds(0.5 / last.rate_hz));
        for (auto other = runs.begin(); other != runs.end(); ++other) {
            for (std::size_t k = 0; k < other->second.segments.size(); ++k) {
                const Segment& candidate = other->second.segments[k];
                const auto at = find_last(last, candidate);
                if (!at) continue;
                run = other;
                segment = k;
                first = *at + 1;
                shift = last_time - candidate.time_of(*at);
            }
        }
    }
    RecordJoiner joiner(data, after, to);
    for (; run != runs.end(); ++run, segment = first = 0, shift = Nanoseconds(0))
        for (; segment < run->second.segments.size(); ++segment, first = 0)
            append(joiner, run->second.segments[segment], first, shift);
}

}  // namespace a351::archive
