#include "protocol/archive/miniseed.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <random>
#include "tests/support/catch.hpp"

#include "tests/support/file_bytes.hpp"

namespace a351::archive {
namespace {

using Samples = std::vector<std::int32_t>;

constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();

RecordHeader header_at(const char* time) {
    RecordHeader header;
    header.network = "XX";
    header.station = "A351";
    header.location = "00";
    header.channel = "BNZ";
    header.start = *parse_rfc3339(time);
    header.nominal_rate = Hertz(50.0);
    header.timing_quality_percent = 80;
    return header;
}

int byte_at(const PackedRecord& record, std::size_t i) {
    return std::to_integer<int>(record.bytes[i]);
}
int u16_at(const PackedRecord& record, std::size_t i) {
    return byte_at(record, i) << 8 | byte_at(record, i + 1);
}

/// Packs all samples into as many records as needed and decodes them again.
Samples through_records(const RecordHeader& header, std::span<const std::int32_t> samples,
                        std::vector<PackedRecord>* records = nullptr) {
    Samples out;
    while (!samples.empty()) {
        const auto record = pack_record(header, samples);
        REQUIRE(record.sample_count > 0);
        REQUIRE(record.sample_count <= samples.size());
        const auto decoded = decode_record(record.bytes);
        REQUIRE(decoded);
        REQUIRE(decoded->samples.size() == record.sample_count);
        out.insert(out.end(), decoded->samples.begin(), decoded->samples.end());
        samples = samples.subspan(record.sample_count);
        if (records) records->push_back(record);
    }
    return out;
}

/// Returns a random walk with steps of up to `step` counts.
Samples random_walk(std::size_t count, std::int32_t step, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Samples samples;
    std::int32_t value = 16'777'216;
    for (std::size_t i = 0; i < count; ++i) {
        const auto range = static_cast<std::uint64_t>(2 * step + 1);
        value += static_cast<std::int32_t>(random() % range) - step;
        samples.push_back(value);
    }
    return samples;
}

}  // namespace

TEST_CASE("a decoded record has the samples and the header that were packed") {
    RecordHeader header = header_at("2026-03-01T12:00:00.123456Z");
    header.sequence = 4711;
    const bool has_declared_rate = GENERATE(false, true);
    if (has_declared_rate) header.declared_rate_hz = 50.000996;
    const auto samples = random_walk(1000, GENERATE(1, 100, 100'000), 1);
    const auto record = pack_record(header, samples);
    CHECK_FALSE(record.is_integer_coded);
    CHECK(record.start == header.start);
    const auto decoded = decode_record(record.bytes);
    REQUIRE(decoded);
    CHECK(decoded->header.network == "XX");
    CHECK(decoded->header.station == "A351");
    CHECK(decoded->header.location == "00");
    CHECK(decoded->header.channel == "BNZ");
    CHECK(decoded->header.sequence == 4711);
    CHECK(decoded->header.start == header.start);
    CHECK(decoded->header.nominal_rate == Hertz(50.0));
    CHECK(decoded->header.timing_quality_percent == 80);
    CHECK(decoded->header.declared_rate_hz.has_value() == has_declared_rate);
    CHECK(decoded->rate_hz() == (has_declared_rate ? static_cast<double>(50.000996F) : 50.0));
    CHECK(std::equal(decoded->samples.begin(), decoded->samples.end(), samples.begin()));
}

TEST_CASE("a start time is kept, rounded to microseconds") {
    const auto rounded = pack_record(header_at("2026-03-01T12:00:00.000000600Z"), Samples{1});
    CHECK(rounded.start == *parse_rfc3339("2026-03-01T12:00:00.000001Z"));
    CHECK(decode_record(rounded.bytes)->header.start == rounded.start);
    std::mt19937_64 random(2);
    const Samples samples{1, 2, 3};
    for (int i = 0; i < 2000; ++i) {
        // 1970 ... 2100
        const auto us = std::chrono::microseconds(random() % 4'102'444'800'000'000ULL);
        RecordHeader header = header_at("2026-01-01T00:00:00Z");
        header.start = UtcTime(us);
        const auto decoded = decode_record(pack_record(header, samples).bytes);
        REQUIRE(decoded);
        REQUIRE(decoded->header.start == header.start);
    }
}

TEST_CASE(
    "header and blockettes 1000, 1001, 100 have each field at its offset in the SEED manual") {
    RecordHeader header = header_at("2024-12-31T23:58:59.765432Z");  // Day 366.
    header.sequence = 42;
    header.declared_rate_hz = 50.001;
    const auto record = pack_record(header, Samples(2000, 7));
    const std::string front(reinterpret_cast<const char*>(record.bytes.data()), 20);
    CHECK(front == "000042D A351 00BNZXX");
    CHECK(u16_at(record, 30) == static_cast<int>(record.sample_count));
    for (const auto& [at, word] : {std::pair(20U, 2024),
                                   {22U, 366},
                                   {28U, 7654},
                                   {32U, 50},
                                   {34U, 1},
                                   {40U, 0},
                                   {42U, 0},
                                   {44U, 128},
                                   {46U, 48},
                                   {48U, 1000},
                                   {50U, 56},
                                   {56U, 1001},
                                   {58U, 64},
                                   {64U, 100},
                                   {66U, 0}}) {
        CAPTURE(at);
        CHECK(u16_at(record, at) == word);
    }
    // Steim-2, big-endian, 2^9 bytes; 765432 us = 7654 x 100 us + 32 us
    for (const auto& [at, byte] : {std::pair(24U, 23),
                                   {25U, 58},
                                   {26U, 59},
                                   {27U, 0},
                                   {36U, 0},
                                   {39U, 3},
                                   {52U, 11},
                                   {53U, 1},
                                   {54U, 9},
                                   {60U, 80},
                                   {61U, 32}}) {
        CAPTURE(at);
        CHECK(byte_at(record, at) == byte);
    }
    const auto rate = static_cast<std::uint32_t>(u16_at(record, 68)) << 16 |
                      static_cast<std::uint32_t>(u16_at(record, 70));
    CHECK(std::bit_cast<float>(rate) == 50.001F);

    header.declared_rate_hz.reset();
    const auto plain = pack_record(header, Samples(2000, 7));
    CHECK(byte_at(plain, 39) == 2);
    CHECK(u16_at(plain, 58) == 0);
    CHECK(u16_at(plain, 44) == 64);
}

TEST_CASE("each flag sets its own bit") {
    const auto flags_with = [](bool RecordHeader::*flag) {
        RecordHeader header = header_at("2026-03-01T12:00:00Z");
        if (flag) header.*flag = true;
        const auto record = pack_record(header, Samples{1, 2});
        const auto decoded = decode_record(record.bytes);
        REQUIRE(decoded);
        if (flag) CHECK(decoded->header.*flag);
        return std::pair(byte_at(record, 37), byte_at(record, 38));
    };
    CHECK(flags_with(nullptr) == std::pair(0x00, 0x00));
    CHECK(flags_with(&RecordHeader::starts_series) == std::pair(0x08, 0x00));
    CHECK(flags_with(&RecordHeader::ends_series) == std::pair(0x10, 0x00));
    CHECK(flags_with(&RecordHeader::is_clock_locked) == std::pair(0x20, 0x00));
    CHECK(flags_with(&RecordHeader::is_clipped) == std::pair(0x00, 0x02));
    CHECK(flags_with(&RecordHeader::had_transmission_errors) == std::pair(0x00, 0x20));
    CHECK(flags_with(&RecordHeader::is_time_questionable) == std::pair(0x00, 0x80));
}

TEST_CASE("a record holds at most 721 samples, 616 with a declared rate") {
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    CHECK(pack_record(header, Samples(5000, 7)).sample_count == kMostSamplesPerRecord);
    header.declared_rate_hz = 50.001;
    CHECK(pack_record(header, Samples(5000, 7)).sample_count == 616);
}

TEST_CASE("a record ends before a jump that Steim-2 cannot hold") {
    const std::int32_t jump = GENERATE(1 << 29, -(1 << 29), kHighest, kLowest);
    Samples samples(20, 0);
    samples.insert(samples.end(), 20, jump);
    std::vector<PackedRecord> records;
    CHECK(through_records(header_at("2026-03-01T12:00:00Z"), samples, &records) == samples);
    REQUIRE(records.size() == 2);
    CHECK(records[0].sample_count == 20);
    CHECK_FALSE(records[0].is_integer_coded);
    CHECK_FALSE(records[1].is_integer_coded);

    const std::int32_t most = (1 << 29) - 1;  // The largest difference that it can hold.
    const Samples large{0, most, 0, -most, 0};
    const auto record = pack_record(header_at("2026-03-01T12:00:00Z"), large);
    CHECK_FALSE(record.is_integer_coded);
    CHECK(decode_record(record.bytes)->samples == large);
}

TEST_CASE("a single wild sample gets a record of plain integers, and Steim-2 continues after it") {
    auto samples = random_walk(300, 10, 3);
    samples[100] = GENERATE(as<std::int32_t>{}, kHighest, kLowest, 0x64000000);
    std::vector<PackedRecord> records;
    CHECK(through_records(header_at("2026-03-01T12:00:00Z"), samples, &records) == samples);
    REQUIRE(records.size() == 3);
    CHECK(records[0].sample_count == 100);
    CHECK(records[1].sample_count == 1);
    CHECK(records[1].is_integer_coded);
    CHECK(byte_at(records[1], 52) == 3);
    CHECK_FALSE(records[2].is_integer_coded);
}

TEST_CASE("a run of wild samples fills records of plain integers") {
    Samples samples;
    for (int i = 0; i < 500; ++i) samples.push_back(i % 2 ? kHighest - i : kLowest + i);
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    CHECK(pack_record(header, samples).sample_count == 112);
    CHECK(through_records(header, samples) == samples);
    header.declared_rate_hz = 50.001;
    CHECK(pack_record(header, samples).sample_count == 109);
    CHECK(through_records(header, samples) == samples);
}

TEST_CASE("any 32-bit integers come back unchanged") {
    std::mt19937_64 random(4);
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    for (int round = 0; round < 60; ++round) {
        if (round % 2) header.declared_rate_hz = 50.001;
        Samples samples;
        const auto width = static_cast<unsigned>(round % 33);
        for (int i = 0; i < 1000; ++i) {
            // Limits all samples but one in 50 to `width` bits, so that both codings alternate.
            const auto bits = static_cast<std::uint32_t>(random());
            const bool is_wild = random() % 50 == 0;
            const auto kept = is_wild || width == 32 ? bits : bits & ((1U << width) - 1);
            samples.push_back(static_cast<std::int32_t>(kept));
        }
        REQUIRE(through_records(header, samples) == samples);
    }
}

TEST_CASE("a record is damaged if its declared rate is far from the nominal rate") {
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    header.declared_rate_hz = 50.001;
    auto record = pack_record(header, Samples(100, 5));
    const auto is_taken = [&record](float rate_hz) {
        const auto bits = std::bit_cast<std::uint32_t>(rate_hz);
        for (std::size_t i = 0; i < 4; ++i)
            record.bytes[68 + i] = static_cast<std::byte>(bits >> (24 - 8 * i));
        return decode_record(record.bytes).has_value();
    };
    for (const float rate_hz : {45.5F, 50.0F, 54.5F}) CHECK(is_taken(rate_hz));
    for (const float rate_hz :
         {1e-39F, 0.0F, -50.0F, 44.5F, 55.5F, 1e38F, std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::quiet_NaN()})
        CHECK_FALSE(is_taken(rate_hz));
}

TEST_CASE("a cut, random or damaged record is refused, or has a possible number of samples") {
    std::mt19937_64 random(5);
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    auto bytes = pack_record(header, Samples(100, 5)).bytes;
    for (std::size_t size = 0; size < kRecordSize; ++size)
        REQUIRE_FALSE(decode_record(std::span(bytes).first(size)));
    for (int round = 0; round < 2000; ++round) {
        for (auto& byte : bytes) byte = static_cast<std::byte>(random() & 0xFF);
        REQUIRE_FALSE(decode_record(bytes));
    }
    int refused = 0;
    constexpr int kRounds = 20'000;
    for (int round = 0; round < kRounds; ++round) {
        if (round == kRounds / 2) header.declared_rate_hz = 50.001;
        auto record = pack_record(header, random_walk(400, 300, 6));
        const auto flips = 1 + random() % 8;
        for (std::size_t i = 0; i < flips; ++i) {
            // Half of the damage is in the header, where it matters most.
            const auto at = random() % (i % 2 ? kRecordSize : 80);
            record.bytes[at] = static_cast<std::byte>(random() & 0xFF);
        }
        const auto decoded = decode_record(record.bytes);
        if (!decoded) ++refused;
        if (decoded) REQUIRE(decoded->samples.size() <= kMostSamplesPerRecord);
    }
    CHECK(refused > kRounds * 9 / 10);
}

TEST_CASE("a flipped bit in the differences of a Steim-2 record is detected by its last sample") {
    const auto record = pack_record(header_at("2026-03-01T12:00:00Z"), random_walk(400, 300, 8));
    // Bytes from the second data frame on, after the first and last sample, without control words.
    for (std::size_t i = 128 + 4; i < 256; ++i) {
        if (i % 64 < 4) continue;
        auto bytes = record.bytes;
        bytes[i] ^= std::byte{0x01};
        REQUIRE_FALSE(decode_record(bytes));
    }
}

TEST_CASE("packing without samples or with an impossible sequence number is refused") {
    RecordHeader header = header_at("2026-03-01T12:00:00Z");
    CHECK_THROWS_AS(pack_record(header, {}), std::invalid_argument);
    header.sequence = GENERATE(0, 1'000'000);
    CHECK_THROWS_AS(pack_record(header, Samples{1}), std::invalid_argument);
}

TEST_CASE("timing quality falls by 20 percent for each decade of error above 1 ms") {
    using namespace std::chrono_literals;
    CHECK(timing_quality_percent(0ns) == 100);
    CHECK(timing_quality_percent(1ms) == 100);
    CHECK(timing_quality_percent(10ms) == 80);
    CHECK(timing_quality_percent(100ms) == 60);
    CHECK(timing_quality_percent(1s) == 40);
    CHECK(timing_quality_percent(10s) == 20);
    CHECK(timing_quality_percent(100s) == 0);
    CHECK(timing_quality_percent(Nanoseconds::max()) == 0);
}

TEST_CASE("packing reproduces the reference record byte for byte") {
    RecordHeader header = header_at("2026-03-01T12:00:00.123456Z");
    header.sequence = 7;
    header.declared_rate_hz = 50.0005;
    header.is_clock_locked = true;
    header.starts_series = true;
    header.timing_quality_percent = 87;
    Samples samples;
    for (int i = 0; i < 200; ++i) samples.push_back(16'000'000 + i * i * (i % 2 ? -3 : 5));
    const auto record = pack_record(header, samples);
    const auto expected =
        test::read_bytes(A351_GOLDEN "/miniseed/XX.A351.00.BNZ_steim2_blockette100.mseed");
    REQUIRE(expected.size() == kRecordSize);
    CHECK(std::equal(expected.begin(), expected.end(), record.bytes.begin()));
    const auto decoded = decode_record(expected);
    REQUIRE(decoded);
    CHECK(std::equal(decoded->samples.begin(), decoded->samples.end(), samples.begin()));
}

}  // namespace a351::archive
