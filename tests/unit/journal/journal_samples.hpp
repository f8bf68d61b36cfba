#pragma once
/// @file
/// One journal header and one chunk of each kind, for tests of the journal.

#include <string_view>

#include "protocol/journal/journal.hpp"
#include "tests/support/file_bytes.hpp"

namespace a351::test {

[[nodiscard]] inline timing::ClockReading clock_reading(std::int64_t raw_s, const char* utc) {
    timing::ClockReading clock;
    clock.raw = RawTime(std::chrono::seconds(raw_s));
    clock.boottime = std::chrono::seconds(raw_s + 5);
    clock.realtime = *parse_rfc3339(utc);
    clock.is_synchronised = true;
    clock.max_error_us = 2500;
    clock.estimated_error_us = 120;
    return clock;
}

[[nodiscard]] inline journal::Header journal_header() {
    journal::Header header;
    header.session = *journal::SessionId::from_hex("000102030405060708090a0b0c0d0e0f");
    header.boot_id = "6b1f0f5e-0000-4000-8000-000000000001";
    header.program_version = "0.1.0";
    header.profile = "A351";
    header.product_id = "A352AD10";
    header.serial_number = "X0000001";
    header.firmware = 0x1234;
    header.output_rate_hz = 50;
    header.filter = "k512_fc9";
    header.burst_ctrl = 0xC701;
    header.baud = 460800;
    header.declared_rate_hz = 50.0005;
    header.clock = clock_reading(1000, "2026-03-01T13:00:00Z");
    return header;
}

[[nodiscard]] inline journal::RxChunk rx_chunk(std::string_view first, std::string_view second) {
    journal::RxChunk rx;
    for (const std::string_view part : {first, second}) {
        const auto bytes = bytes_of(part);
        rx.bytes.insert(rx.bytes.end(), bytes.begin(), bytes.end());
        rx.reads.push_back({static_cast<std::uint32_t>(rx.bytes.size()),
                            RawTime(std::chrono::milliseconds(1'000'100 + 20 * rx.reads.size()))});
    }
    return rx;
}

/// Returns a header, then one chunk of each other kind.
[[nodiscard]] inline std::vector<journal::Chunk> one_of_each() {
    using namespace journal;
    journal::TxChunk tx{RawTime(std::chrono::milliseconds(1'000'050)), {}};
    for (const int byte : {0xFE, 0x00, 0x0D}) tx.bytes.push_back(static_cast<std::byte>(byte));
    journal::ModelChunk model;
    model.index = 4999;
    model.time = {*parse_rfc3339("2026-03-01T13:01:40.123456789Z"), Nanoseconds(750'000),
                  timing::State::locked};
    journal::MarkChunk mark{journal_header().session,
                            {{"BNZ", 4500, *parse_rfc3339("2026-03-01T13:01:30Z")},
                             {"LK1", 89, *parse_rfc3339("2026-03-01T13:01:29.5Z")}}};
    const journal::OvenChunk poll{RawTime(std::chrono::milliseconds(1'102'000)),
                                  journal::OvenOutcome::answered,
                                  1,
                                  {425, 0x0100, 425, 0, 250}};
    return {journal_header(),
            tx,
            clock_reading(1001, "2026-03-01T13:00:01.000000001Z"),
            rx_chunk("\x80"
                     "ABC",
                     "DEF\r"),
            model,
            journal::EventChunk{R"({"type":"note","utc":"2026-03-01T13:01:00Z","note":"wind"})"},
            mark,
            poll};
}

}  // namespace a351::test
