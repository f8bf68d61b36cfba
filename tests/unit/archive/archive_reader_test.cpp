#include "protocol/archive/archive_reader.hpp"

#include <numeric>
#include "tests/support/catch.hpp"

#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351::files;
using namespace a351::journal;

namespace a351::archive {
namespace {

using namespace std::chrono_literals;

const UtcTime kBegin = *parse_rfc3339("2026-03-01T12:00:00Z");
constexpr Nanoseconds kStep = 20ms;

class Archive {
public:
    /// Writes a record of the 100 samples first, first + 1, ...
    void add(UtcTime start, std::int32_t first, const char* channel = "BNZ",
             std::optional<double> rate_hz = std::nullopt) {
        RecordHeader header;
        header.network = "XX";
        header.station = "A351";
        header.location = "00";
        header.channel = channel;
        header.start = start;
        header.nominal_rate = Hertz(50.0);
        header.declared_rate_hz = rate_hz;
        std::vector<std::int32_t> samples(100);
        std::iota(samples.begin(), samples.end(), first);
        const auto record = pack_record(header, samples);
        REQUIRE(record.sample_count == 100);
        writer_.append(channel, record);
    }

    /// Writes records without a gap, with the samples 0, 1, 2 ...
    void add_some(int records, std::optional<double> rate_hz = std::nullopt) {
        for (int i = 0; i < records; ++i) add(kBegin + i * 100 * kStep, i * 100, "BNZ", rate_hz);
    }

    [[nodiscard]] ChannelData read(UtcTime from = kBegin - 48h, UtcTime to = kBegin + 48h) const {
        return read_channel(directory_.path(), StationCodes{}, "BNZ", from, to);
    }

    [[nodiscard]] const std::filesystem::path& path() const { return directory_.path(); }

    [[nodiscard]] std::filesystem::path day_file(UtcTime time = kBegin) const {
        return sds_file(directory_.path(), StationCodes{}, "BNZ", time);
    }

private:
    test::TemporaryDirectory directory_;
    SdsWriter writer_{posix_files(), directory_.path(), StationCodes{}};
};

}  // namespace

TEST_CASE(
    "a day file longer than a piece is read like a short one, with damage at the end of a piece") {
    constexpr std::size_t kPiece = 1U << 16U;
    constexpr std::size_t kRecords = kPiece / kRecordSize + 40;
    Archive archive;
    archive.add_some(static_cast<int>(kRecords));
    const auto whole = test::read_bytes(archive.day_file());
    for (const std::size_t before : {0U, 1U, 7U, 511U}) {   // bytes before the first record
        for (const std::size_t within : {0U, 5U, 1030U}) {  // and after the last one of the piece
            CAPTURE(before, within);
            constexpr std::size_t kAt = kPiece - kRecordSize;
            auto bytes = whole;
            bytes.insert(bytes.begin() + kAt, within, std::byte{'#'});
            bytes.insert(bytes.begin(), before, std::byte{'#'});
            bytes.insert(bytes.end(), whole.begin(), whole.begin() + kRecordSize);  // twice
            bytes.insert(bytes.end(), 100, std::byte{'0'});
            test::write_bytes(archive.day_file(), bytes);
            const auto data = archive.read();
            REQUIRE(data.segments.size() == 1);
            std::vector<std::int32_t> expected(kRecords * 100);
            std::iota(expected.begin(), expected.end(), 0);
            CHECK(data.segments[0].counts == expected);
            std::vector<std::pair<std::uint64_t, std::uint64_t>> damage, found;
            if (before > 0) damage.emplace_back(0, before);
            if (within > 0) damage.emplace_back(kAt + before, within);
            damage.emplace_back(bytes.size() - 100, 100);
            for (const Damage& one : data.damage) found.emplace_back(one.offset, one.byte_count);
            CHECK(found == damage);
        }
    }
}

TEST_CASE("a rate in headers that contradicts the metadata: the starts of the records decide") {
    const auto read = [](double header_hz, double metadata_hz) {
        Archive archive;  // its samples are 1/50 s apart
        archive.add_some(3, header_hz);
        return read_channel(archive.path(), StationCodes{}, "BNZ", kBegin - 48h, kBegin + 48h,
                            metadata_hz);
    };
    const ChannelData repaired = read(49.0, 50.0);
    REQUIRE(repaired.segments.size() == 1);
    CHECK(repaired.segments[0].time_of(199) == kBegin + 199 * kStep);
    REQUIRE(repaired.rate_conflict.has_value());
    CHECK(repaired.rate_conflict->header_hz == 49.0);
    CHECK(repaired.rate_conflict->observed_hz == Approx(50.0).epsilon(1e-6));
    CHECK(repaired.rate_conflict->used_hz == 50.0);
    CHECK(repaired.rate_conflict->longest_s == Approx(2.0).epsilon(1e-6));

    const ChannelData wrong_metadata = read(50.0, 49.0);
    CHECK(wrong_metadata.segments.size() == 1);
    CHECK(wrong_metadata.rate_conflict->used_hz == 50.0);
    CHECK_FALSE(read(50.005, 50.0).rate_conflict.has_value());  // a clock of 100 ppm
    CHECK(read(49.0, 49.0).segments.size() == 3);

    // Records of another rate that is right do not decide about the wrong ones.
    Archive archive;
    archive.add_some(3, 49.0);
    for (int i = 0; i < 9; ++i) archive.add(kBegin + 1h + i * 100 * kStep, i * 100, "BNZ", 50.001);
    const auto both =
        read_channel(archive.path(), StationCodes{}, "BNZ", kBegin - 48h, kBegin + 48h, 50.0);
    REQUIRE(both.segments.size() == 2);
    CHECK(both.segments[0].rate_hz == 50.0);
    CHECK(both.segments[1].rate_hz == Approx(50.001));
}

TEST_CASE("a day file that one channel lacks is named, once the day is longer than a record") {
    Archive archive;
    const auto absent = [&] {
        std::string text;
        for (const auto& [channel, day, compressed] : absent_day_files(
                 archive.path(), StationCodes{}, {"BN1", "BN2", "BNZ"}, kBegin - 48h, kBegin + 48h))
            text += channel + " " + to_rfc3339(day).substr(0, 10) +
                    compressed.extension().string() + "; ";
        return text;
    };
    CHECK(absent() == "");
    archive.add(kBegin - 24h, 0, "BN1");  // one record, as on a running day
    for (const UtcTime at : {kBegin, kBegin + 118s}) archive.add(at, 0, "BN1");
    archive.add(kBegin, 0, "BNZ");
    CHECK(absent() == "BN2 2026-03-01; ");
    for (const UtcTime at : {kBegin - 3s, kBegin + 130s}) archive.add(at - 24h, 0, "BN2");
    CHECK(absent() == "BNZ 2026-02-28; BN2 2026-03-01; ");
    for (const auto& file : day_files(archive.path(), StationCodes{}, "BN1", kBegin, kBegin + 1h))
        std::filesystem::rename(file, file.string() + ".gz");
    CHECK(absent() == "BNZ 2026-02-28; BN1 2026-03-01.gz; ");
}

TEST_CASE("records that a merged copy has twice count once") {
    Archive archive;
    archive.add_some(5);
    archive.add(kBegin, 7);  // other samples at a known time: the clock was set back
    const auto once = test::read_bytes(archive.day_file());
    auto twice = once;
    twice.insert(twice.end(), once.begin(), once.end());
    twice.insert(twice.end(), once.begin() + kRecordSize, once.begin() + 2 * kRecordSize);
    twice[twice.size() - kRecordSize] = std::byte{'9'};  // numbered again
    test::write_bytes(archive.day_file(), twice);
    const auto data = archive.read();
    CHECK(data.damage.empty());
    REQUIRE(data.segments.size() == 2);
    CHECK(data.segments[0].counts.size() == 500);
    CHECK(data.segments[1].counts.size() == 100);
}

TEST_CASE("a record that begins in second 60 is read before midnight only") {
    const bool is_leap_second = GENERATE(true, false);
    constexpr std::size_t kSecondAt = 26;  // SEED 2.4, fixed section of the header
    Archive archive;
    archive.add(*parse_rfc3339(is_leap_second ? "2026-03-01T23:59:59Z" : "2026-03-01T12:00:59Z"),
                0);
    auto bytes = test::read_bytes(archive.day_file());
    REQUIRE(bytes[kSecondAt] == std::byte{59});
    bytes[kSecondAt] = std::byte{60};
    test::write_bytes(archive.day_file(), bytes);
    const auto data = archive.read();
    REQUIRE(data.segments.size() == (is_leap_second ? 1 : 0));
    CHECK(data.damage.empty() == is_leap_second);
    if (is_leap_second)
        CHECK(data.segments[0].time_of(0) == *parse_rfc3339("2026-03-02T00:00:00Z"));
}

TEST_CASE("a gap or overlap of more than half a sample, or another rate, begins a new segment") {
    for (const auto& [shift, segments] :
         {std::pair(0ms, 1U), std::pair(3ms, 1U), std::pair(10ms, 1U), std::pair(-10ms, 1U),
          std::pair(11ms, 2U), std::pair(-11ms, 2U)}) {
        Archive archive;
        archive.add(kBegin, 0);
        archive.add(kBegin + 100 * kStep + shift, 100);
        const auto data = archive.read();
        CHECK(data.damage.empty());
        REQUIRE(data.segments.size() == segments);
        if (segments > 1) continue;
        const auto& segment = data.segments[0];
        REQUIRE(segment.counts.size() == 200);
        CHECK(segment.rate_hz == 50.0);
        CHECK(segment.anchors.size() == 2);
        for (int i = 0; i < 200; ++i) {  // Each record keeps its own start time.
            CHECK(segment.counts[std::size_t(i)] == i);
            CHECK(segment.time_of(std::size_t(i)) ==
                  kBegin + i * kStep + (i < 100 ? Nanoseconds(0) : Nanoseconds(shift)));
        }
    }
    Archive faster;
    faster.add(kBegin, 0, "BNZ", 50.0);
    faster.add(kBegin + 100 * kStep, 100, "BNZ", 50.0005);
    const auto data = faster.read();
    REQUIRE(data.segments.size() == 2);
    CHECK(data.segments[1].rate_hz == static_cast<double>(50.0005F));

    Archive stepped_back;  // Segments are in time order.
    stepped_back.add(kBegin, 0);
    stepped_back.add(kBegin - 10s, 100);
    REQUIRE(stepped_back.read().segments.size() == 2);
    CHECK(stepped_back.read().segments[0].counts.front() == 100);
}

TEST_CASE("a segment continues across UTC midnight") {
    Archive archive;
    const auto midnight = kBegin + 12h;
    archive.add(midnight - 100 * kStep, 0);
    archive.add(midnight, 100);
    CHECK(archive.day_file(midnight - 1ns) != archive.day_file(midnight));
    CHECK(archive.read().segments.size() == 1);
    CHECK(archive.read(kBegin - 48h, midnight).segments[0].counts.size() == 100);
    CHECK(archive.read(midnight, kBegin + 48h).segments[0].counts.front() == 100);
}

TEST_CASE(
    "a read returns the samples from the start of the interval up to, but not including, its end") {
    Archive archive;
    archive.add_some(3);
    const auto data = archive.read(kBegin + 150 * kStep, kBegin + 250 * kStep);
    REQUIRE(data.segments.size() == 1);
    CHECK(data.segments[0].counts.front() == 150);
    CHECK(data.segments[0].counts.back() == 249);
    CHECK(data.segments[0].time_of(0) == kBegin + 150 * kStep);
    CHECK(data.segments[0].time_of(99) == kBegin + 249 * kStep);
    CHECK(archive.read(kBegin + 1ns, kBegin + 20ms).segments.empty());
    CHECK(archive.read(kBegin, kBegin).segments.empty());
}

TEST_CASE("a missing day, channel or archive gives no samples and no error") {
    Archive archive;
    CHECK(archive.read().segments.empty());
    archive.add(kBegin, 0, "BN1");
    CHECK(archive.read().segments.empty());
    CHECK(read_channel("/nonexistent", {}, "BNZ", kBegin, kBegin + 1h).segments.empty());
    CHECK(archive.read(UtcTime::min(), UtcTime::max()).segments.empty());
}

TEST_CASE("damage within a day file costs only the damaged records and is reported") {
    using Bytes = std::vector<std::byte>;
    using Sizes = std::vector<std::size_t>;
    struct Case {
        const char* reason;
        void (*damage)(Bytes&);
        Sizes segments;
        std::uint64_t offset, byte_count;
    };
    for (const auto& [reason, damage, segments, offset, byte_count] : {
             Case{"offset 512: 512 bytes are not a record",
                  [](Bytes& bytes) { std::fill_n(bytes.begin() + 512, 512, std::byte{0}); },
                  {100, 200},
                  512,
                  512},
             Case{"offset 1024: 200 bytes are not a record",
                  [](Bytes& bytes) { bytes.insert(bytes.begin() + 1024, 200, std::byte{0xAA}); },
                  {400},
                  1024,
                  200},
             Case{"offset 1536: 511 bytes are not a record",
                  [](Bytes& bytes) { bytes.pop_back(); },
                  {300},
                  1536,
                  511},
             Case{"offset 512: 512 bytes are a record of another station",
                  [](Bytes& bytes) { bytes[kRecordSize + 8] = std::byte{'B'}; },  // B351
                  {100, 200},
                  512,
                  512},
         }) {
        Archive archive;
        archive.add_some(4);
        auto bytes = test::read_bytes(archive.day_file());
        damage(bytes);
        test::write_bytes(archive.day_file(), bytes);
        const auto data = archive.read();
        Sizes sizes;
        for (const Segment& segment : data.segments) sizes.push_back(segment.counts.size());
        CHECK(sizes == segments);
        CHECK(data.segments.back().counts.back() == (byte_count == 511 ? 299 : 399));
        REQUIRE(data.damage.size() == 1);
        CHECK(data.damage[0].offset == offset);
        CHECK(data.damage[0].byte_count == byte_count);
        CHECK_THAT(to_text(data.damage[0]), EndsWith(reason));
    }
}

}  // namespace a351::archive
