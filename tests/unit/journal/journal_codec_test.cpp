#include "protocol/journal/journal_codec.hpp"

#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/journal/chunk_payload.hpp"
#include "protocol/journal/journal_header_json.hpp"
#include "tests/unit/journal/journal_samples.hpp"

namespace a351::journal {
namespace {

std::span<const std::byte> payload_of(const std::vector<std::byte>& chunk) {
    return std::span(chunk).subspan(kChunkHeaderSize);
}

/// Returns a chunk after encoding and decoding.
template <class T>
T coded(const T& chunk) {
    const auto bytes = encode_chunk(chunk, 1);
    return std::get<T>(decode_payload(static_cast<ChunkType>(bytes[4]), payload_of(bytes)).value());
}

std::optional<Header> parsed(const Header& header) { return parse_header(header_to_json(header)); }

std::uint32_t crc32c_of(std::span<const std::byte> nine_or_more) {
    // chunk_crc() covers length, type and sequence, little-endian, then the payload.
    const auto header = decode_chunk_header(nine_or_more.first(9));
    return chunk_crc(header, nine_or_more.subspan(9));
}

}  // namespace

TEST_CASE("a session identifier is kept as 32 hexadecimal digits") {
    const std::string hex = "00112233445566778899aabbccddeeff";
    const auto id = SessionId::from_hex(hex);
    REQUIRE(id);
    CHECK(id->bytes[0] == 0x00);
    CHECK(id->bytes[15] == 0xFF);
    CHECK(id->to_hex() == hex);
    CHECK_FALSE(SessionId::from_hex(hex.substr(1)));
    CHECK_FALSE(SessionId::from_hex(hex + "0"));
    CHECK_FALSE(SessionId::from_hex("00112233445566778899AABBCCDDEEFF"));
    CHECK_FALSE(SessionId::from_hex("00112233445566778899aabbccddeefg"));
}

TEST_CASE("the checksum is CRC-32C with the check values of RFC 3720, B.4") {
    std::vector<std::byte> bytes(32, std::byte{0});
    CHECK(crc32c_of(bytes) == 0x8A9136AA);
    bytes.assign(32, std::byte{0xFF});
    CHECK(crc32c_of(bytes) == 0x62A8AB43);
    for (std::size_t i = 0; i < 32; ++i) bytes[i] = static_cast<std::byte>(i);
    CHECK(crc32c_of(bytes) == 0x46DD794E);
}

TEST_CASE("each kind of chunk has the same bytes again after decoding and encoding") {
    std::uint32_t sequence = 0;
    for (const auto& chunk : test::one_of_each()) {
        const auto bytes = encode_chunk(chunk, sequence++);
        const auto header = decode_chunk_header(std::span(bytes).first(kChunkHeaderSize));
        CHECK(header.length + kChunkHeaderSize == bytes.size());
        const auto decoded = decode_payload(static_cast<ChunkType>(header.type), payload_of(bytes));
        REQUIRE(decoded);
        CHECK(decoded->index() == chunk.index());
        CHECK(encode_chunk(*decoded, header.sequence) == bytes);
    }
}

TEST_CASE("a decoded header has all fields that were encoded") {
    auto header = test::journal_header();
    header.is_device_assumed = true;
    header.start_up_test = wire::StartUpTest::flash_error;
    header.port = "/dev/serial/by-id/adapter";
    const auto fields = [](const Header& h) {
        return std::tie(h.session, h.boot_id, h.codes, h.profile, h.product_id, h.serial_number,
                        h.firmware, h.output_rate_hz, h.filter, h.burst_ctrl, h.baud,
                        h.declared_rate_hz, h.is_device_assumed, h.start_up_test, h.port, h.clock);
    };
    CHECK(fields(parsed(header).value()) == fields(header));
    auto uncommissioned = header;
    uncommissioned.declared_rate_hz.reset();
    uncommissioned.oven_interval = std::chrono::seconds(10);
    CHECK(parsed(uncommissioned)->oven_interval == std::chrono::seconds(10));
    uncommissioned.oven_interval = std::chrono::seconds(0);  // The archive needs more than 0.
    CHECK_FALSE(parsed(uncommissioned));
    uncommissioned.oven_interval = std::chrono::seconds(1);
    CHECK(parsed(uncommissioned)->record_age == std::chrono::seconds(60));
    uncommissioned.record_age = std::chrono::seconds(1);
    CHECK(parsed(uncommissioned)->record_age == std::chrono::seconds(1));
    for (const int wrong_s : {0, 61}) {
        uncommissioned.record_age = std::chrono::seconds(wrong_s);
        CHECK_FALSE(parsed(uncommissioned));
    }
    uncommissioned.record_age = std::chrono::seconds(60);
    CHECK(header_to_json(uncommissioned).find("oven_interval") == std::string::npos);
    uncommissioned.outer_oven_interval = std::chrono::seconds(5);
    CHECK(parsed(uncommissioned)->outer_oven_interval == std::chrono::seconds(5));
    CHECK(parsed(uncommissioned)->oven_interval == std::chrono::seconds(1));
    uncommissioned.outer_oven_interval = std::chrono::seconds(1);
    CHECK_FALSE(parsed(uncommissioned)->declared_rate_hz);
    uncommissioned.declared_rate_hz =
        1.2 * uncommissioned.output_rate_hz;  // No record can have it.
    CHECK_FALSE(parsed(uncommissioned));
    const auto as_asked = parsed(test::journal_header());
    CHECK_FALSE(as_asked->is_device_assumed);
    CHECK(as_asked->port.empty());
    CHECK(as_asked->start_up_test == wire::StartUpTest::passed);
    std::string wrong = header_to_json(header);
    wrong.replace(wrong.find("FLASH_ERR"), 9, "perhaps");
    CHECK_FALSE(parse_header(wrong));
}

TEST_CASE(
    "a header with a missing field, or with codes that would name another directory, is refused") {
    for (const char* const other : {"", "[]", "{"}) CHECK_FALSE(parse_header(other));
    const auto json = header_to_json(test::journal_header());
    for (const std::string key : {"session", "boot_id", "axes", "clock", "baud", "raw_ns"}) {
        auto without = json;
        without.replace(without.find("\"" + key), key.size() + 1, "\"no_" + key);
        CHECK_FALSE(parse_header(without));
    }
    auto of_other_type = json;
    of_other_type.replace(of_other_type.find("460800"), 6, "\"fast\"");
    CHECK_FALSE(parse_header(of_other_type));
    CHECK(parsed(Header()));
    for (const StationCodes& codes :
         {StationCodes{.network = "."}, StationCodes{.network = ""},
          StationCodes{.station = "../.."}, StationCodes{.station = "A35-"},
          StationCodes{.location = "/"}, StationCodes{.axes = {"1", "/x", "Z"}}}) {
        Header header;
        header.codes = codes;
        CHECK_FALSE(parsed(header));
    }
}

TEST_CASE("a chunk with a time outside the usable range is refused") {
    timing::ClockReading clock;
    const auto comes_back = [&] {
        return decode_payload(ChunkType::clock, payload_of(encode_chunk(clock, 1))).has_value();
    };
    clock.realtime = UtcTime(kLatestInstant);
    clock.raw = RawTime(kEarliestInstant);
    CHECK(comes_back());
    clock.realtime += Nanoseconds(1);
    CHECK_FALSE(comes_back());
    clock.realtime = UtcTime();
    clock.raw -= Nanoseconds(1);
    CHECK_FALSE(comes_back());
    Header header;
    header.clock = clock;
    CHECK_FALSE(parsed(header));
    RxChunk rx;
    rx.bytes.resize(1);
    rx.reads.push_back({1, RawTime(kLatestInstant + Nanoseconds(1))});
    CHECK_FALSE(decode_payload(ChunkType::rx, payload_of(encode_chunk(rx, 1))));
}

TEST_CASE("values at the limits of their fields are decoded as they were encoded") {
    ModelChunk model;
    model.time.utc = UtcTime(std::chrono::seconds(11));
    model.time.uncertainty = std::chrono::hours(24 * 365 * 57);  // After a start in 1970.
    CHECK(coded(model).time.uncertainty == kLongestSpan);
    RxChunk rx;  // The time stamps of reads keep their order and their nanoseconds.
    rx.bytes.resize(300);
    rx.reads = {{1, RawTime(Nanoseconds(5'000'000'001))},
                {200, RawTime(Nanoseconds(5'000'000'000))},  // Clock went back; kept as it is.
                {300, RawTime(Nanoseconds(9'999'999'999))}};
    CHECK(coded(rx).reads == rx.reads);
    auto header = test::journal_header();
    for (const auto leap :
         {timing::LeapSecond::none, timing::LeapSecond::inserted, timing::LeapSecond::removed}) {
        header.clock.leap = leap;
        CHECK(parsed(header)->clock == header.clock);
        CHECK(coded(header.clock) == header.clock);
    }
    header.serial_number = "\xFF\x01\"\\";  // no text
    CHECK(parsed(header).value().serial_number == "\xEF\xBF\xBD\x01\"\\");
}

TEST_CASE("a payload that is cut anywhere is refused, unless it ends in a field of free length") {
    for (const auto& chunk : test::one_of_each()) {
        const auto bytes = encode_chunk(chunk, 0);
        const auto type = static_cast<ChunkType>(bytes[4]);
        const auto payload = payload_of(bytes);
        for (std::size_t size = 0; size < payload.size(); ++size) {
            const auto decoded = decode_payload(type, payload.first(size));
            // Only these end in a field of free length.
            const bool may_be_shorter =
                type == ChunkType::tx || type == ChunkType::event || type == ChunkType::mark;
            CHECK((!decoded || may_be_shorter));
        }
    }
}

TEST_CASE("a read count larger than the payload is refused before memory is allocated") {
    auto bytes = encode_chunk(test::rx_chunk("a", "b"), 1);
    auto payload = std::vector<std::byte>(bytes.begin() + kChunkHeaderSize, bytes.end());
    for (std::size_t i = 8; i < 12; ++i) payload[i] = std::byte{0xFF};
    CHECK_FALSE(decode_payload(ChunkType::rx, payload));
}

TEST_CASE("a decoded poll of an oven has all fields that were encoded, the place in its type") {
    for (const OvenPlace place : {OvenPlace::inner, OvenPlace::outer}) {
        for (const OvenOutcome outcome :
             {OvenOutcome::answered, OvenOutcome::timed_out, OvenOutcome::bad_crc,
              OvenOutcome::exception, OvenOutcome::other_unit, OvenOutcome::malformed,
              OvenOutcome::no_port}) {
            OvenChunk poll{RawTime(Nanoseconds(-7)), outcome, 2, {}};
            if (outcome == OvenOutcome::answered) poll.registers = {0xFF9C, 0x8001, 0x01A9};
            const auto inner = encode_chunk(poll, 1);
            poll.place = place;
            const auto bytes = encode_chunk(poll, 1);
            CHECK(bytes[4] == (place == OvenPlace::inner ? std::byte{8} : std::byte{9}));
            CHECK(std::ranges::equal(payload_of(inner), payload_of(bytes)));
            const auto read = coded(poll);
            CHECK(read.time == poll.time);
            CHECK(read.outcome == outcome);
            CHECK(read.decimals == 2);
            CHECK(read.registers == poll.registers);
            CHECK(read.place == place);
        }
    }
}

TEST_CASE("a poll of unknown outcome, or with registers that do not fit its outcome, is refused") {
    const OvenChunk silent{RawTime(), OvenOutcome::timed_out, 1, {}};
    const auto bytes = encode_chunk(silent, 1);
    std::vector<std::byte> payload(bytes.begin() + kChunkHeaderSize, bytes.end());
    payload[8] = std::byte{7};  // One more than no_port.
    CHECK_FALSE(decode_payload(ChunkType::oven, payload));
    payload[8] = std::byte{0};  // Answered, but without registers.
    CHECK_FALSE(decode_payload(ChunkType::oven, payload));
    CHECK_THROWS_AS(encode_chunk(OvenChunk{RawTime(), OvenOutcome::bad_crc, 1, {425}}, 1),
                    std::invalid_argument);
    CHECK_THROWS_AS(
        encode_chunk(
            OvenChunk{RawTime(), OvenOutcome::answered, 1, std::vector<std::uint16_t>(256)}, 1),
        std::invalid_argument);
}

TEST_CASE("a chunk that violates the format is not encoded") {
    RxChunk rx = test::rx_chunk("ab", "c");
    rx.reads.back().end = 2;
    CHECK_THROWS_AS(encode_chunk(rx, 1), std::invalid_argument);
    CHECK_THROWS_AS(encode_chunk(RxChunk{}, 1), std::invalid_argument);
    CHECK_NOTHROW(encode_chunk(EventChunk{std::string(kMostPayloadBytes, 'x')}, 1));
    CHECK_THROWS_AS(encode_chunk(EventChunk{std::string(kMostPayloadBytes + 1, 'x')}, 1),
                    std::invalid_argument);
}

}  // namespace a351::journal
