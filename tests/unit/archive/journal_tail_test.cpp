#include "protocol/archive/journal_tail.hpp"

#include <cstdio>
#include <cstdlib>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_reader.hpp"
#include "tests/unit/archive/data_root.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

constexpr std::int64_t kCount = 90'000;  // 30 min
const UtcTime kFrom = kStart - 1h, kTo = kStart + 2h;

/// Returns half an hour behind an adapter with a timer of 16 ms; three samples are missing.
std::vector<Chunk> half_an_hour() {
    JournalStream stream;
    std::mt19937_64 random(7);
    for (std::int64_t k = 0; k < kCount; ++k) {
        if (k >= 88'000 && k < 88'003) continue;
        const auto late = Nanoseconds(static_cast<std::int64_t>(random() % 300'000));
        const auto timer = 16ms - due(k) % 16ms;
        stream.bytes(frame_of(values_of(k)), due(k) + timer + late);
        if (k % 50 == 49) stream.second(due(k) + 17ms);
    }
    stream.flush();
    return stream.chunks;
}

/// Returns chunks whose host clock is ahead.
std::vector<Chunk> ahead(std::vector<Chunk> chunks, Nanoseconds by) {
    for (Chunk& chunk : chunks) {
        if (auto* header = std::get_if<Header>(&chunk)) header->clock.realtime += by;
        if (auto* reading = std::get_if<timing::ClockReading>(&chunk)) reading->realtime += by;
    }
    return chunks;
}

/// Archives the first chunks and leaves the samples of open records to the journal.
void archive_part(const DataRoot& root, const std::vector<Chunk>& chunks, std::size_t count) {
    archive::Writer writer(files::posix_files(), root.archive(), {});
    Archiver archiver(writer);
    for (std::size_t i = 0; i < count; ++i) archiver.take(chunks[i]);
    static_cast<void>(writer.sync());
}

ChannelData channel_of(const DataRoot& root, const std::string& channel) {
    return read_channel(root.archive(), {}, channel, kFrom, kTo);
}

UtcTime last_of(const ChannelData& data) {
    const Segment& last = data.segments.back();
    return last.time_of(last.counts.size() - 1);
}

/// Returns channels with the journal's tail, which is read once for all, as in the corrector.
std::vector<ChannelData> with_tails(const DataRoot& root, const std::vector<std::string>& channels,
                                    Nanoseconds longest_session = JournalTail::kLongestSession) {
    std::vector<ChannelData> all;
    UtcTime from = kTo;
    for (const std::string& channel : channels) {
        all.push_back(channel_of(root, channel));
        from = std::min(from, all.back().segments.empty() ? kFrom : last_of(all.back()));
    }
    const JournalTail tail(root.journal(), {}, from, kTo, longest_session);
    for (std::size_t i = 0; i < channels.size(); ++i)
        tail.append_to(all[i], channels[i], kFrom, kTo);
    return all;
}

ChannelData with_tail(const DataRoot& root, const std::string& channel) {
    return with_tails(root, {channel}).front();
}

std::vector<std::int32_t> counts_of(const ChannelData& data) {
    std::vector<std::int32_t> counts;
    for (const Segment& segment : data.segments)
        counts.insert(counts.end(), segment.counts.begin(), segment.counts.end());
    return counts;
}

/// Returns the largest difference of the times of equal samples, ms.
double most_difference_ms(const ChannelData& one, const ChannelData& other) {
    Nanoseconds most{0};
    for (std::size_t k = 0; k < std::min(one.segments.size(), other.segments.size()); ++k) {
        const Segment &a = one.segments[k], &b = other.segments[k];
        for (std::size_t i = 0; i < std::min(a.counts.size(), b.counts.size()); ++i)
            most = std::max(most, std::chrono::abs(a.time_of(i) - b.time_of(i)));
    }
    return std::chrono::duration<double, std::milli>(most).count();
}

}  // namespace

TEST_CASE("the journal's tail has the samples that the archive lacks, at the archive's times") {
    // From the begin of the session to the nanosecond, from the last quarter of an hour nearly so.
    const auto [longest_session, most_ms] =
        GENERATE(std::pair<Nanoseconds, double>{JournalTail::kLongestSession, 0.0},
                 std::pair<Nanoseconds, double>{0h, 0.2});
    const auto chunks = half_an_hour();
    const DataRoot whole;
    archive_all(whole, chunks);
    for (const double part : {0.0, 0.001, 0.3, 0.6, 0.8, 0.93, 0.97, 0.98, 0.999, 1.0}) {
        const DataRoot root;
        root.write_journal(chunks);
        archive_part(root, chunks,
                     static_cast<std::size_t>(part * static_cast<double>(chunks.size())));
        const std::vector<std::string> channels{"BNZ", "BN1", "BK1"};
        const auto all = with_tails(root, channels, longest_session);
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const auto& channel = channels[i];
            CAPTURE(channel, part);
            const ChannelData expected = channel_of(whole, channel);
            const std::size_t archived = counts_of(channel_of(root, channel)).size();
            const ChannelData& data = all[i];
            REQUIRE(data.segments.size() == 2);  // no gap but the one of the stream
            REQUIRE(counts_of(data) == counts_of(expected));
            const double ms = most_difference_ms(data, expected);
            CAPTURE(archived, ms);
            REQUIRE(ms <= most_ms);
            const Segment::Anchor& newest = data.segments.back().anchors.back();
            const Segment::Anchor& wanted = expected.segments.back().anchors.back();
            CHECK(newest.is_time_questionable == wanted.is_time_questionable);
            CHECK(std::abs(newest.timing_quality_percent - wanted.timing_quality_percent) <= 20);
            if (channel == "BNZ")
                std::printf("%zu of %lld samples archived: the tail's times differ by %.3f ms\n",
                            archived, static_cast<long long>(kCount), ms);
        }
    }
}

TEST_CASE("the tail continues the times of an archive whose clock was 70 ms ahead") {
    const auto chunks = half_an_hour();
    const DataRoot whole, root;
    archive_all(whole, ahead(chunks, 70ms));
    root.write_journal(chunks);
    archive_part(root, ahead(chunks, 70ms), chunks.size() * 8 / 10);
    const ChannelData data = with_tail(root, "BNZ");
    CHECK(data.segments.size() == 2);
    CHECK(most_difference_ms(data, channel_of(whole, "BNZ")) < 0.2);
}

TEST_CASE("a journal that was cut at any byte ends the tail there") {
    const auto chunks = half_an_hour();
    const DataRoot root, cut;
    root.write_journal(chunks);
    archive_part(root, chunks, chunks.size() * 9 / 10);
    const auto expected = counts_of(with_tail(root, "BNZ"));
    const std::size_t archived = counts_of(channel_of(root, "BNZ")).size();
    std::mt19937 random(3);
    for (int i = 0; i < 10; ++i) {
        cut.copy_from(root);
        const auto newest = segment_files(cut.journal()).back();
        const auto size = std::filesystem::file_size(newest);
        const auto kept = i == 0 ? 0 : size - random() % (size / 8);
        std::filesystem::resize_file(newest, kept);
        CAPTURE(kept, size);
        const auto counts = counts_of(with_tail(cut, "BNZ"));
        REQUIRE(counts.size() >= archived);
        REQUIRE(std::equal(counts.begin(), counts.end(), expected.begin()));
        if (kept == size) REQUIRE(counts == expected);
    }
}

TEST_CASE("a session that began after the archive's last record is in the tail") {
    JournalStream first(1), second(2, 100s);
    first.frames(0, 4'000);
    second.frames(6'000, 12'000);
    auto chunks = first.chunks;
    const std::size_t archived = chunks.size();
    chunks.insert(chunks.end(), second.chunks.begin(), second.chunks.end());
    const DataRoot root;
    root.write_journal(chunks);
    archive_part(root, chunks, archived);
    const ChannelData data = with_tail(root, "BNZ");
    CHECK(counts_of(data).size() == 10'000);
    REQUIRE(data.segments.size() == 2);
    CHECK(std::chrono::abs(last_of(data) - (kStart + due(11'999))) < 100ms);
}

TEST_CASE("the end of a journal is its newest clock reading, also of a tail that reached it") {
    const DataRoot root;
    CHECK(!journal_end(root.journal()));
    root.write_journal(half_an_hour());
    CHECK(journal_end(root.journal()) == kStart + due(kCount - 1) + 17ms);
    CHECK(JournalTail(root.journal(), {}, kFrom, kTo).end() == journal_end(root.journal()));
    CHECK(!JournalTail(root.journal(), {}, kFrom, kStart + 10min).end());
}

TEST_CASE("a host clock that was ahead at the start and set back does not end the tail") {
    auto chunks = half_an_hour();
    const auto set_back = chunks.begin() + static_cast<std::ptrdiff_t>(chunks.size() / 10);
    std::ranges::copy(ahead({chunks.begin(), set_back}, 3h), chunks.begin());  // beyond kTo
    const DataRoot root;
    root.write_journal(chunks);
    CHECK(counts_of(with_tail(root, "BNZ")).size() > kCount * 7 / 10);
}
