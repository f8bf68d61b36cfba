#include <string>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_codec.hpp"
#include "sim/replay/journal_recording.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/sim/replay/replay_host.hpp"

namespace a351::sim::replay {
namespace {

using namespace std::chrono_literals;

const UtcTime kJournalStart = *parse_rfc3339("2026-03-01T12:00:00Z");
constexpr RawTime kRawStart{1000s};

journal::Header header_of(std::uint8_t session, Nanoseconds since_start = 0s) {
    journal::Header header;
    header.session.bytes[0] = session;
    header.boot_id = "boot";
    header.program_version = "test";
    header.profile = "A352AD10";
    header.product_id = "A352AD10";
    header.serial_number = "T0000007";
    header.firmware = 0x0102;
    header.output_rate_hz = 50;
    header.filter = "k512_fc9";
    header.burst_ctrl = 0xC703;
    header.baud = 460800;
    header.clock.raw = kRawStart + since_start;
    header.clock.realtime = kJournalStart + since_start;
    return header;
}

/// Returns one read of `text`, received `since_start`.
journal::RxChunk read_of(const std::string& text, Nanoseconds since_start) {
    const auto bytes = test::bytes_of(text);
    return {{bytes.begin(), bytes.end()},
            {{static_cast<std::uint32_t>(text.size()), kRawStart + since_start}}};
}

/// A directory of segments, and the device that replays them.
class Recorded {
public:
    std::filesystem::path segment(const std::vector<journal::Chunk>& chunks) {
        auto bytes = journal::encode_preamble();
        std::uint32_t sequence = 0;
        for (const auto& chunk : chunks) {
            const auto more = journal::encode_chunk(chunk, sequence++);
            bytes.insert(bytes.end(), more.begin(), more.end());
        }
        files_.push_back(directory_.path() /
                         ("0000000" + std::to_string(files_.size() + 1) + "_x.a351j"));
        test::write_bytes(files_.back(), bytes);
        return files_.back();
    }

    /// Adds a segment with one word each after 5, 6 and 9 s.
    void three_words() {
        segment({header_of(1), read_of("one", 5s), read_of("two", 6s), read_of("three", 9s)});
    }

    [[nodiscard]] Device device(Timing timing = Timing::as_recorded) const {
        return {std::make_unique<JournalRecording>(files_), timing, Nanoseconds(0)};
    }

private:
    test::TemporaryDirectory directory_;
    std::vector<std::filesystem::path> files_;
};

std::string text_of(const SentPieces& line) {
    std::string text;
    for (const std::byte byte : line.bytes()) text += static_cast<char>(byte);
    return text;
}

constexpr const char* kProfile = "A352AD10";

}  // namespace

TEST_CASE("a device that replays a journal has the identity of the recorded unit",
          "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("a", 5s)});
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    const auto identity = host.configure({}, kProfile);
    CHECK(identity.product_id == "A352AD10");
    CHECK(identity.serial_number == "T0000007");
    CHECK(identity.firmware == 0x0102);
    CHECK(device.baud() == 460800);
}

TEST_CASE("a device that replays a journal starts at the recorded baud rate", "[sim][replay]") {
    Recorded recorded;
    auto header = header_of(1);
    header.baud = 115200;
    recorded.segment({header, read_of("a", 5s)});
    Device device = recorded.device();
    CHECK(device.baud() == 115200);
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    CHECK(device.baud() == 115200);
}

TEST_CASE("recorded bytes leave at their recorded times, and not before the host starts sampling",
          "[sim][replay]") {
    Recorded recorded;
    recorded.three_words();
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.wait(4s);
    host.configure({}, kProfile);
    CHECK(device.next_due() == kJournalStart + 5s);
    host.wait_until(kJournalStart + 5s - 1ns);
    CHECK(host.line.pieces.empty());
    host.listen();
    REQUIRE(host.line.pieces.size() == 3);
    CHECK(text_of(host.line) == "onetwothree");
    CHECK(host.line.pieces[0].leaves == kJournalStart + 5s);
    CHECK(host.line.pieces[1].leaves == kJournalStart + 6s);
    CHECK(host.line.pieces[2].leaves == kJournalStart + 9s);
    CHECK_FALSE(device.next_due());
}

TEST_CASE("reads of one chunk keep their own times", "[sim][replay]") {
    Recorded recorded;
    journal::RxChunk chunk = read_of("abcdef", 5s);
    chunk.reads = {{2, kRawStart + 5s}, {3, kRawStart + 5500ms}, {6, kRawStart + 7s}};
    // Raw time goes back to 6 s, as no real clock does: the order of the reads is kept.
    recorded.segment({header_of(1), chunk, read_of("earlier", 6s)});
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.listen();
    REQUIRE(host.line.pieces.size() == 4);
    CHECK(host.line.pieces[1].bytes.size() == 1);
    CHECK(host.line.pieces[1].leaves == kJournalStart + 5500ms);
    CHECK(host.line.pieces[2].leaves == kJournalStart + 7s);
    CHECK(host.line.pieces[3].leaves == kJournalStart + 7s);
}

TEST_CASE("a host that starts late gets the missed bytes at once and the rest on time",
          "[sim][replay]") {
    Recorded recorded;
    recorded.three_words();
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart + 7s);
    host.configure({}, kProfile);
    host.wait(0s);
    CHECK(text_of(host.line) == "onetwo");
    CHECK(host.line.pieces.front().leaves == kJournalStart + 7s);
    host.listen();
    CHECK(text_of(host.line) == "onetwothree");
    CHECK(host.line.pieces.back().leaves == kJournalStart + 9s);
}

TEST_CASE("without a shared clock the recording begins when the host begins", "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("one", 5s), read_of("two", 6s)});
    Device device = recorded.device(Timing::from_host_start);
    ReplayHost host(device, kJournalStart + 24h);
    host.wait(1h);
    host.configure({}, kProfile);
    host.listen();
    REQUIRE(host.line.pieces.size() == 2);
    CHECK(host.line.pieces[0].leaves == kJournalStart + 25h);
    CHECK(host.line.pieces[1].leaves == kJournalStart + 25h + 1s);
}

TEST_CASE("a replay as fast as it is read sends whenever the line accepts more", "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("one", 5s), read_of("two", 600s), read_of("3", 700s)});
    Device device = recorded.device(Timing::as_fast_as_read);
    ReplayHost host(device, kJournalStart - 1h);
    host.configure({}, kProfile);
    host.line.capacity = 2;
    host.wait(0s);
    CHECK(text_of(host.line) == "onetwo");
    CHECK(device.next_due() == host.now());
    host.line.pieces.clear();
    host.wait(0s);
    CHECK(text_of(host.line) == "3");
    CHECK_FALSE(device.next_due());
}

TEST_CASE("segments of a session follow each other without a break", "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("one", 5s)});
    recorded.segment({header_of(1, 6s)});
    recorded.segment({header_of(1, 7s), read_of("two", 8s)});
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "onetwo");
    CHECK(device.report().sessions == 1);
    CHECK_FALSE(device.next_due());
}

TEST_CASE("segments with one session id are two sessions if the boot differs or raw time goes back",
          "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1, 10s), read_of("one", 15s)});
    auto other_day = header_of(1);
    other_day.clock.realtime += 24h;
    if (GENERATE(false, true)) {
        other_day.boot_id = "another";
        other_day.clock.raw += 10s;
    }
    const Nanoseconds read = other_day.clock.raw - kRawStart + 5s;
    recorded.segment({other_day, read_of("two", read)});
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "one");
    host.line.pieces.clear();
    host.configure({}, kProfile);
    host.wait_until(kJournalStart + 24h);
    host.listen();
    CHECK(text_of(host.line) == "two");
    CHECK(host.line.pieces.back().leaves == kJournalStart + 24h + 5s);
    CHECK(device.report().sessions == 2);
}

TEST_CASE("a session ends in configuration mode, and the next waits for a new start",
          "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("one", 5s)});
    recorded.segment({header_of(2, 6s)});  // A session without a byte.
    auto third = header_of(3, 20s);
    third.serial_number = GENERATE("T0000007", "T0000008");
    recorded.segment({third, read_of("three", 25s)});
    const auto timing = GENERATE(Timing::as_recorded, Timing::as_fast_as_read);
    Device device = recorded.device(timing);
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "one");
    host.wait(1h);
    CHECK(text_of(host.line) == "one");
    REQUIRE(device.next_due());
    host.line.pieces.clear();
    CHECK(host.configure({}, kProfile).serial_number == third.serial_number);
    host.listen();
    CHECK(text_of(host.line) == "three");
    CHECK(device.report().sessions == 2);
    CHECK_FALSE(device.next_due());
}

TEST_CASE("a host that stops and starts again continues with the next recorded byte",
          "[sim][replay]") {
    Recorded recorded;
    recorded.three_words();
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.wait_until(kJournalStart + 5s);
    CHECK(text_of(host.line) == "one");
    host.stop();
    host.wait(30s);
    CHECK(text_of(host.line) == "one");
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "twothree");
    CHECK(device.report().sessions == 1);
}

TEST_CASE("bytes that a host has not seen when it stops are replayed when it starts again",
          "[sim][replay]") {
    Recorded recorded;
    recorded.three_words();
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.wait_until(kJournalStart + 6s);
    host.line.seen = 1;
    host.stop();
    CHECK(text_of(host.line) == "one");
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "twothree");
}

TEST_CASE("a host that took a paused replay for a silent sensor misses no byte", "[sim][replay]") {
    Recorded recorded;
    recorded.three_words();
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.wait_until(kJournalStart + 5s);
    host.line.seen = 1;
    host.wait_until(kJournalStart + 8s);
    for (const auto& command : wire::read_mode()) host.send(command);
    REQUIRE(host.line.pieces.size() == 2);
    const auto mode = wire::parse_answer(wire::kModeCtrl, host.line.pieces.back().bytes);
    REQUIRE(mode);
    CHECK(wire::ConfigMode::from_mode_ctrl(*mode));
    host.wait_until(kJournalStart + 10s);
    CHECK(host.line.pieces.size() == 2);
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "twothree");
    CHECK(device.report().sessions == 1);
    CHECK(device.report().restarts == 1);
    CHECK(device.report().longest_delay == 1s);
}

TEST_CASE("a clock step of the recording host is not replayed within a boot, a step back never",
          "[sim][replay]") {
    Recorded recorded;
    recorded.segment({header_of(1), read_of("one", 5s)});
    auto stepped = header_of(2, 10s);
    stepped.clock.realtime += 1h;
    recorded.segment({stepped, read_of("two", 12s)});
    auto rebooted = header_of(3, 20s);
    rebooted.boot_id = "another";
    rebooted.clock.raw = RawTime(3s);
    recorded.segment({rebooted, {journal::RxChunk{{std::byte{1}}, {{1, RawTime(5s)}}}}});
    auto set_back = rebooted;
    set_back.session.bytes[0] = 4;
    set_back.boot_id = "a third";
    set_back.clock.realtime -= 24h;
    recorded.segment({set_back, {journal::RxChunk{{std::byte{1}}, {{1, RawTime(9s)}}}}});
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    std::vector<UtcTime> left;
    for (int session = 0; session < 4; ++session) {
        host.configure({}, kProfile);
        host.listen();
        left.push_back(host.line.pieces.back().leaves);
    }
    CHECK(left == std::vector<UtcTime>{kJournalStart + 5s, kJournalStart + 12s, kJournalStart + 22s,
                                       kJournalStart + 22s});
}

TEST_CASE("settings other than the recorded ones are refused in one line", "[sim][replay]") {
    Recorded recorded;
    const auto file = recorded.segment({header_of(1), read_of("one", 5s)});
    wire::SensorSettings settings;
    const auto refusal = [&] {
        Device device = recorded.device();
        ReplayHost host(device, kJournalStart);
        try {
            host.configure(settings, kProfile);
        } catch (const std::runtime_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string recorded_with =
        "; " + file.string() + " was recorded with 50 Hz, k512_fc9, BURST_CTRL 0xC703";
    CHECK(refusal().empty());
    settings.output_rate_hz = 100;
    CHECK(refusal() == "the host asks for 100 Hz, k512_fc9, BURST_CTRL 0xC703" + recorded_with);
    settings = {};
    settings.layout = *wire::BurstLayout::from_burst_ctrl(0x4702);
    CHECK(refusal() == "the host asks for 50 Hz, k512_fc9, BURST_CTRL 0x4702" + recorded_with);
    settings = {};
    settings.filter_code = 0xE;
    CHECK(refusal() == "the host asks for 50 Hz, user512, BURST_CTRL 0xC703" + recorded_with);
}

TEST_CASE("a damaged tail is left out and reported, and good data before and after it are replayed",
          "[sim][replay]") {
    Recorded recorded;
    const auto file =
        recorded.segment({header_of(1), read_of("one", 5s), read_of("two", 6s), read_of("x", 7s)});
    recorded.segment({header_of(1, 10s), read_of("three", 12s)});
    auto bytes = test::read_bytes(file);
    const std::size_t last_chunk = journal::kChunkHeaderSize + 12 + 12 + 1;
    bytes[bytes.size() - 1] ^= std::byte{1};
    test::write_bytes(file, bytes);
    Device device = recorded.device();
    ReplayHost host(device, kJournalStart);
    host.configure({}, kProfile);
    host.listen();
    CHECK(text_of(host.line) == "onetwothree");
    REQUIRE(device.recording().damage().size() == 1);
    const RecordingDamage& damage = device.recording().damage().front();
    CHECK(damage.file == file);
    CHECK(damage.offset == bytes.size() - last_chunk);
    CHECK(damage.byte_count == last_chunk);
    CHECK(damage.reason == "wrong checksum");
}

}  // namespace a351::sim::replay
