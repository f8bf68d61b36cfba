#include <string>
#include "tests/support/catch.hpp"

#include "sim/replay/journal_recording.hpp"
#include "tests/unit/journal/segment_fixture.hpp"
#include "tests/unit/sim/replay/replay_host.hpp"

namespace a351::sim::replay {
namespace {

using namespace std::chrono_literals;
using journal::segment_of;

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

/// Returns a segment with one word each after 5, 6 and 9 s.
journal::Bytes three_words() {
    return segment_of({header_of(1), read_of("one", 5s), read_of("two", 6s), read_of("three", 9s)});
}

/// A directory of segments, the device that replays them, and its host.
struct Replay {
    explicit Replay(const std::vector<journal::Bytes>& segments,
                    Timing timing = Timing::as_recorded, UtcTime begin = kJournalStart)
        : device(std::make_unique<JournalRecording>(written(segments)), timing, Nanoseconds(0)),
          host(device, begin) {}

    wire::DeviceIdentity configure(const wire::SensorSettings& settings = {}) {
        return host.configure(settings, "A352AD10");
    }

    std::vector<std::filesystem::path> written(const std::vector<journal::Bytes>& segments) {
        for (const journal::Bytes& segment : segments) {
            files.push_back(directory.path() /
                            ("0000000" + std::to_string(files.size() + 1) + "_x.a351j"));
            test::write_bytes(files.back(), segment);
        }
        return files;
    }

    [[nodiscard]] std::string heard() const {
        std::string text;
        for (const std::byte byte : host.line.bytes()) text += static_cast<char>(byte);
        return text;
    }

    /// Returns the times at which the pieces have left, since the start of the recording.
    [[nodiscard]] std::vector<Nanoseconds> left() const {
        std::vector<Nanoseconds> times;
        for (const auto& piece : host.line.pieces) times.push_back(piece.leaves - kJournalStart);
        return times;
    }

    test::TemporaryDirectory directory;
    std::vector<std::filesystem::path> files;
    Device device;
    ReplayHost host;
};

using Times = std::vector<Nanoseconds>;

}  // namespace

TEST_CASE("a device that replays a journal has the identity and baud rate of the recorded unit") {
    auto header = header_of(1);
    header.baud = 115200;
    Replay replay({segment_of({header, read_of("a", 5s)})});
    CHECK(replay.device.baud() == 115200);
    const auto identity = replay.configure();
    CHECK(identity.product_id == "A352AD10");
    CHECK(identity.serial_number == "T0000007");
    CHECK(identity.firmware == 0x0102);
    CHECK(replay.device.baud() == 115200);
}

TEST_CASE("recorded bytes leave at their recorded times, and not before the host starts sampling") {
    journal::RxChunk chunk = read_of("abcdef", 6s);
    chunk.reads = {{2, kRawStart + 6s}, {3, kRawStart + 6500ms}, {6, kRawStart + 9s}};
    // Raw time goes back to 7 s, as no real clock does: the order of the reads is kept.
    Replay replay({segment_of({header_of(1), read_of("one", 5s), chunk, read_of("-", 7s)})});
    replay.host.wait(4s);
    replay.configure();
    CHECK(replay.device.next_due() == kJournalStart + 5s);
    replay.host.wait_until(kJournalStart + 5s - 1ns);
    CHECK(replay.host.line.pieces.empty());
    replay.host.listen();
    CHECK(replay.heard() == "oneabcdef-");
    CHECK(replay.left() == Times{5s, 6s, 6500ms, 9s, 9s});
    CHECK(replay.host.line.pieces.at(2).bytes.size() == 1);
    CHECK_FALSE(replay.device.next_due());
}

TEST_CASE("a host that starts late gets the missed bytes at once and the rest on time") {
    Replay replay({three_words()}, Timing::as_recorded, kJournalStart + 7s);
    replay.configure();
    replay.host.wait(0s);
    CHECK(replay.heard() == "onetwo");
    replay.host.listen();
    CHECK(replay.heard() == "onetwothree");
    CHECK(replay.left() == Times{7s, 7s, 9s});
}

TEST_CASE("without a shared clock the recording begins when the host begins") {
    Replay replay({three_words()}, Timing::from_host_start, kJournalStart + 24h);
    replay.host.wait(1h);
    replay.configure();
    replay.host.listen();
    CHECK(replay.left() == Times{25h, 25h + 1s, 25h + 4s});
}

TEST_CASE("a replay as fast as it is read sends whenever the line accepts more") {
    Replay replay({three_words()}, Timing::as_fast_as_read, kJournalStart - 1h);
    replay.configure();
    replay.host.line.capacity = 2;
    replay.host.wait(0s);
    CHECK(replay.heard() == "onetwo");
    CHECK(replay.device.next_due() == replay.host.now());
    replay.host.line.pieces.clear();
    replay.host.wait(0s);
    CHECK(replay.heard() == "three");
    CHECK_FALSE(replay.device.next_due());
}

TEST_CASE("segments with one session id are two sessions if the boot differs or raw time goes back") {
    auto other_day = header_of(1);
    other_day.clock.realtime += 24h;
    if (GENERATE(false, true)) {
        other_day.boot_id = "another";
        other_day.clock.raw += 10s;
    }
    const Nanoseconds read = other_day.clock.raw - kRawStart + 5s;
    Replay replay({segment_of({header_of(1, 10s), read_of("one", 15s)}),
                   segment_of({other_day, read_of("two", read)})});
    replay.configure();
    replay.host.listen();
    CHECK(replay.heard() == "one");
    replay.configure();
    replay.host.wait_until(kJournalStart + 24h);
    replay.host.listen();
    CHECK(replay.heard() == "two");
    CHECK(replay.left() == Times{24h + 5s});
    CHECK(replay.device.report().sessions == 2);
}

TEST_CASE("a session ends in configuration mode, and the next waits for a new start") {
    auto third = header_of(3, 20s);
    third.serial_number = GENERATE("T0000007", "T0000008");
    const auto timing = GENERATE(Timing::as_recorded, Timing::as_fast_as_read);
    Replay replay({segment_of({header_of(1), read_of("one", 5s)}),
                   segment_of({header_of(2, 6s)}),  // A session without a byte.
                   segment_of({third, read_of("three", 25s)})},
                  timing);
    replay.configure();
    replay.host.listen();
    replay.host.wait(1h);
    CHECK(replay.heard() == "one");
    REQUIRE(replay.device.next_due());
    CHECK(replay.configure().serial_number == third.serial_number);
    replay.host.listen();
    CHECK(replay.heard() == "three");
    CHECK(replay.device.report().sessions == 2);
    CHECK_FALSE(replay.device.next_due());
}

TEST_CASE("a host that stops and starts again continues with the first byte it has not seen") {
    const bool has_seen_all = GENERATE(true, false);
    Replay replay({three_words()});
    replay.configure();
    replay.host.wait_until(kJournalStart + (has_seen_all ? 5s : 6s));
    if (!has_seen_all) replay.host.line.seen = 1;
    replay.host.stop();
    replay.host.wait(30s);
    CHECK(replay.heard() == "one");
    replay.configure();
    replay.host.listen();
    CHECK(replay.heard() == "twothree");
    CHECK(replay.device.report().sessions == 1);
}

TEST_CASE("a host that took a paused replay for a silent sensor misses no byte") {
    Replay replay({three_words()});
    ReplayHost& host = replay.host;
    replay.configure();
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
    replay.configure();
    host.listen();
    CHECK(replay.heard() == "twothree");
    CHECK(replay.device.report().sessions == 1);
    CHECK(replay.device.report().restarts == 1);
    CHECK(replay.device.report().longest_delay == 1s);
}

TEST_CASE("a clock step of the recording host is not replayed within a boot, a step back never") {
    auto stepped = header_of(2, 10s);
    stepped.clock.realtime += 1h;
    auto rebooted = header_of(3, 20s);
    rebooted.boot_id = "another";
    rebooted.clock.raw = RawTime(3s);
    auto set_back = rebooted;
    set_back.session.bytes[0] = 4;
    set_back.boot_id = "a third";
    set_back.clock.realtime -= 24h;
    const auto byte_at = [](RawTime time) { return journal::RxChunk{{std::byte{1}}, {{1, time}}}; };
    Replay replay({segment_of({header_of(1), read_of("one", 5s)}),
                   segment_of({stepped, read_of("two", 12s)}),
                   segment_of({rebooted, byte_at(RawTime(5s))}),
                   segment_of({set_back, byte_at(RawTime(9s))})});
    for (const Nanoseconds expected : Times{5s, 12s, 22s, 22s}) {
        replay.configure();
        replay.host.listen();
        CHECK(replay.left().back() == expected);
    }
}

TEST_CASE("settings other than the recorded ones are refused in one line") {
    wire::SensorSettings settings;
    std::string asked;
    SECTION("the recorded ones") {}
    SECTION("rate") {
        settings.output_rate_hz = 100;
        asked = "100 Hz, k512_fc9, BURST_CTRL 0xC703";
    }
    SECTION("layout") {
        settings.layout = *wire::BurstLayout::from_burst_ctrl(0x4702);
        asked = "50 Hz, k512_fc9, BURST_CTRL 0x4702";
    }
    SECTION("filter") {
        settings.filter_code = 0xE;
        asked = "50 Hz, user512, BURST_CTRL 0xC703";
    }
    Replay replay({three_words()});
    if (asked.empty()) {
        CHECK_NOTHROW(replay.configure(settings));
    } else {
        CHECK_THROWS_WITH(replay.configure(settings),
                          "the host asks for " + asked + "; " + replay.files[0].string() +
                              " was recorded with 50 Hz, k512_fc9, BURST_CTRL 0xC703");
    }
}

TEST_CASE("a damaged tail is left out and reported, and good data before and after it are replayed") {
    auto damaged =
        segment_of({header_of(1), read_of("one", 5s), read_of("two", 6s), read_of("x", 7s)});
    damaged.back() ^= std::byte{1};
    Replay replay({damaged, segment_of({header_of(1, 9s)}),
                   segment_of({header_of(1, 10s), read_of("three", 12s)})});
    replay.configure();
    replay.host.listen();
    CHECK(replay.heard() == "onetwothree");  // Segments of a session follow without a break.
    CHECK(replay.device.report().sessions == 1);
    CHECK_FALSE(replay.device.next_due());
    REQUIRE(replay.device.recording().damage().size() == 1);
    const RecordingDamage& damage = replay.device.recording().damage().front();
    const std::size_t last_chunk = journal::kChunkHeaderSize + 12 + 12 + 1;
    CHECK(damage.file == replay.files[0]);
    CHECK(damage.offset == damaged.size() - last_chunk);
    CHECK(damage.byte_count == last_chunk);
    CHECK(damage.reason == "wrong checksum");
}

}  // namespace a351::sim::replay
