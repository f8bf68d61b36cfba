#include "sim/device/register_machine.hpp"

#include <catch2/catch.hpp>

#include "protocol/wire/handshake.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
using namespace std::chrono_literals;

namespace {

constexpr SensorSample kSample{{-203896, 604794, 16713252}, 2466};

std::string frames_of(Bench& bench, int samples) {
    std::vector<std::byte> frames;
    for (int i = 0; i < samples; ++i) {
        static_cast<void>(bench.machine.sample(kSample, frames));
    }
    return hex_of(frames);
}

}  // namespace

TEST_CASE("where the host cuts its bytes is indifferent", "[sim][register_machine]") {
    const auto commands = bytes_of("FE 01 0D 85 06 0D 04 00 0D FE 00 0D 02 00 0D");
    Bench whole;
    std::vector<std::byte> expected;
    whole.machine.receive(commands, whole.now, expected);
    REQUIRE(hex_of(expected) == "04 06 00 0D 02 04 00 0D");
    for (std::size_t cut = 0; cut <= commands.size(); ++cut) {
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(std::span(commands).first(cut), bench.now, answers);
        bench.machine.receive(std::span(commands).subspan(cut), bench.now, answers);
        REQUIRE(answers == expected);
    }
}

TEST_CASE("damaged commands are passed over and the next one is understood",
          "[sim][register_machine]") {
    const std::string mode = "02 04 00 0D";
    for (const std::string damage :
         {"0D", "0D 0D 0D 0D", "FE", "FE 00", "12 34 56 78", "02 00 55"}) {
        CAPTURE(damage);
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(bytes_of(damage), bench.now, answers);
        CHECK(answers.empty());
        // A lone CR twice, as hosts send it, ends whatever was half received.
        bench.machine.receive(bytes_of("0D 0D"), bench.now, answers);
        answers.clear();
        bench.machine.receive(bytes_of("02 00 0D"), bench.now, answers);
        CHECK(hex_of(answers) == mode);
    }
}

TEST_CASE("a partial command is forgotten after 100 ms", "[sim][register_machine]") {
    Bench bench;
    std::vector<std::byte> answers;
    bench.machine.receive(bytes_of("02 00"), bench.now, answers);
    bench.machine.receive(bytes_of("0D"), bench.now + 100ms, answers);
    CHECK(hex_of(answers) == "02 04 00 0D");
    answers.clear();
    bench.machine.receive(bytes_of("02 00"), bench.now + 200ms, answers);
    bench.machine.receive(bytes_of("0D"), bench.now + 301ms, answers);
    CHECK(answers.empty());
}

TEST_CASE("every register answers with its default after start-up", "[sim][register_machine]") {
    Bench bench;
    for (const wire::Register& reg : wire::kRegisters) {
        if (reg.address == 0x7E || reg.name.starts_with("SERIAL") || reg.name == "VERSION")
            continue;
        const std::string window = reg.window == wire::Window::w0 ? "FE 00" : "FE 01";
        const std::string address = hex_of(std::vector{std::byte{reg.address}});
        const auto value = static_cast<std::uint16_t>(reg.default_value);
        CAPTURE(reg.name);
        CHECK(bench.send({window, address + " 00"}) ==
              address + " " +
                  hex_of(std::vector{static_cast<std::byte>(value >> 8),
                                     static_cast<std::byte>(value & 0xFF)}) +
                  " 0D");
    }
    CHECK(bench.send({"FE 01", "7E 00"}) == "7E 00 01 0D");
    CHECK(bench.send({"FE 00", "50 00"}) == "50 00 00 0D");
}

TEST_CASE("identity is spelled with the first character in the low byte",
          "[sim][register_machine]") {
    // M-A352AD10 data sheet 7.27, 7.29: A352AD10, serial number 01234567.
    Bench bench;
    CHECK(bench.send({"FE 01", "6A 00", "6C 00", "6E 00", "70 00"}) ==
          "6A 33 41 0D 6C 32 35 0D 6E 44 41 0D 70 30 31 0D");
    CHECK(bench.send({"72 00", "74 00", "76 00", "78 00", "7A 00"}) ==
          "72 00 0D 0D 74 31 30 0D 76 33 32 0D 78 35 34 0D 7A 37 36 0D");
}

TEST_CASE("only the writable bytes take a write, and only their defined bits",
          "[sim][register_machine]") {
    // Writable byte addresses of the data sheet, tables 7.1 to 7.30, without the commands that do
    // something at once (MODE_CTRL, GLOB_CMD, tests) and the registers that refuse reserved codes.
    Bench bench;
    CHECK(bench.send({"FE 01", "80 FF", "81 FF", "00 00"}) == "00 8E F4 0D");
    CHECK(bench.send({"82 FF", "02 00"}) == "02 00 66 0D");
    CHECK(bench.send({"84 FF", "04 00"}) == "04 04 00 0D");  // SMPL_CTRL low: not writable.
    CHECK(bench.send({"87 FF", "06 00"}) == "06 00 08 0D");  // FILTER_CTRL high: not writable.
    CHECK(bench.send({"8C FF", "8D FF", "0C 00"}) == "0C C7 03 0D");
    CHECK(bench.send({"9A 34", "9B 0A", "1A 00"}) == "1A 0A 34 0D");
    CHECK(bench.send({"9C FF", "9E FF", "1C 00", "1E 00"}) == "1C 00 03 0D 1E 00 0F 0D");
    CHECK(bench.send({"AD 01", "AC 3A", "AF E1", "AE 47", "2C 00", "2E 00"}) ==
          "2C 01 3A 0D 2E E1 47 0D");
    CHECK(bench.send({"C7 05", "C6 FB", "46 00"}) == "46 05 FB 0D");
    CHECK(bench.send({"EA FF", "EB FF", "6A 00"}) == "6A 33 41 0D");
    CHECK(bench.send({"FE 00", "8A FF", "B0 FF", "0A 00", "30 00"}) == "0A 00 00 0D 30 FF FF 0D");
}

TEST_CASE("reserved codes of rate, filter, baud and window are not taken",
          "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "85 00", "85 07", "04 00"}) == "04 04 00 0D");
    CHECK(bench.send({"86 00", "86 0F", "06 00"}) == "06 00 08 0D");
    CHECK(bench.send({"89 00", "08 00"}) == "08 01 00 0D");
    CHECK(bench.send({"FE 02", "04 00"}) == "04 04 00 0D");
}

TEST_CASE("start-up answers NOT_READY and nothing else", "[sim][register_machine]") {
    Bench bench;
    bench.now = 100ms;
    CHECK(bench.send({"FE 00", "02 00", "FE 01", "0A 00", "85 06"}) == "0A 04 00 0D");
    bench.now = RegisterMachine::kPowerOnTime;
    CHECK(bench.send({"0A 00", "04 00"}) == "0A 00 00 0D 04 04 00 0D");
}

TEST_CASE("a soft reset restores the defaults, in sampling too", "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    CHECK(bench.send({"FE 01", "8A 80"}).empty());
    CHECK_FALSE(bench.machine.is_sampling());
    CHECK(bench.send({"FE 01", "0A 00"}) == "0A 04 00 0D");
    bench.now += RegisterMachine::kResetTime;
    CHECK(bench.send({"0A 00", "04 00", "FE 00", "02 00"}) ==
          "0A 00 00 0D 04 04 00 0D 02 04 00 0D");
}

TEST_CASE("MODE_CMD clears itself and MODE_STAT follows", "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"83 01", "02 00"}) == "02 00 00 0D");
    CHECK(bench.machine.is_sampling());
    CHECK(bench.send({"83 02", "02 00"}) == "02 04 00 0D");
    CHECK_FALSE(bench.machine.is_sampling());
}

TEST_CASE("in sampling all writes but mode, reset and window are ignored",
          "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"83 01", "FE 01", "85 06", "80 00", "04 00", "00 00"}) ==
          "04 04 00 0D 00 8E 04 0D");
}

TEST_CASE("in window 1 the byte that starts sampling starts a self test",
          "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "83 01", "02 00"}) == "02 01 26 0D");
    CHECK_FALSE(bench.machine.is_sampling());
    bench.now += RegisterMachine::kSelfTestTime;
    CHECK(bench.send({"02 00"}) == "02 00 26 0D");
    CHECK(bench.send({"83 10"}).empty());
    bench.now += RegisterMachine::kSelfTestTime;
    CHECK(bench.send({"02 00"}) == "02 10 26 0D");
    bench.now += RegisterMachine::kSensitivityTestTime;
    CHECK(bench.send({"02 00", "FE 00", "04 00"}) == "02 00 26 0D 04 00 00 0D");
}

TEST_CASE("FILTER_STAT is busy for its time", "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "86 06", "06 00"}) == "06 00 26 0D");
    bench.now += RegisterMachine::kFilterTime;
    CHECK(bench.send({"06 00"}) == "06 00 06 0D");
}

TEST_CASE("a rate and filter that do not fit give ALIASI_ERR and 100 g on all axes",
          "[sim][register_machine]") {
    Bench bench;  // Factory: 200 Hz with 60 Hz; 50 Hz leaves it invalid.
    CHECK(bench.send({"FE 00", "06 00", "FE 01", "85 06", "FE 00", "06 00"}) ==
          "06 00 00 0D 06 00 02 0D");
    bench.send({"FE 01", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    const std::string frames = frames_of(bench, 8);
    CHECK(frames.substr(0, 8) == "80 8E 02");
    CHECK(frames.substr(21, 35) == "64 00 00 00 64 00 00 00 64 00 00 00");
    CHECK(bench.send({"83 02", "FE 01", "86 06", "FE 00", "06 00"}) == "06 00 00 0D");
}

TEST_CASE("frames start after the transient, with one step in COUNT", "[sim][register_machine]") {
    // Suppressed samples of data sheet table 5.4.
    struct Case {
        std::string_view rate, filter;
        int suppressed, step;
    };
    for (const Case c : {Case{"85 06", "86 06", 7, 80}, Case{"85 05", "86 06", 15, 40},
                         Case{"85 04", "86 08", 31, 20}, Case{"85 03", "86 08", 63, 8},
                         Case{"85 02", "86 08", 127, 4}, Case{"85 02", "86 04", 31, 4},
                         Case{"85 03", "86 04", 15, 8}, Case{"85 04", "86 03", 7, 20},
                         Case{"85 02", "86 02", 15, 4}, Case{"85 03", "86 01", 7, 8}}) {
        Bench bench;
        bench.send({"FE 01", c.rate, c.filter, "88 01", "FE 00", "83 01"});
        std::vector<std::byte> frames;
        for (int i = 0; i < c.suppressed; ++i) {
            REQUIRE_FALSE(bench.machine.sample(kSample, frames));
        }
        REQUIRE(frames.empty());
        REQUIRE(bench.machine.sample(kSample, frames)->count == c.step);
        REQUIRE(bench.machine.sample(kSample, frames)->count == 2 * c.step);
        // After a restart it begins anew; stopped, the register keeps the last value.
        CHECK(bench.send({"83 02", "0A 00"}).substr(0, 2) == "0A");
        bench.send({"83 01"});
        for (int i = 0; i < c.suppressed; ++i) {
            REQUIRE_FALSE(bench.machine.sample(kSample, frames));
        }
        REQUIRE(bench.machine.sample(kSample, frames)->count == c.step);
        CHECK(bench.machine.sampling_run() == 2);
    }
}

TEST_CASE("a recorder's frame carries flags, temperature, axes, count and checksum",
          "[sim][register_machine]") {
    // Values of a real A352's register dump; words 8E00 0000 09A2 FFFC E388 0009 3A7A 00FF 0624
    // 0050 add up to BD1C modulo 65536.
    Bench bench;
    bench.start_logging();
    CHECK(frames_of(bench, 8) ==
          "80 8E 00 00 00 09 A2 FF FC E3 88 00 09 3A 7A 00 FF 06 24 00 50 BD 1C 0D");
}

TEST_CASE("in manual mode the burst command sends the newest sample once a frame",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "8C 03", "8D C7", "FE 00", "83 01"});
    CHECK(frames_of(bench, 8).empty());
    CHECK(bench.send({"06 00"}) == "06 8E 00 0D");
    CHECK(bench.send({"80 00"}).substr(0, 8) == "80 8E 00");
    // The sample has been read: its new-data flags are gone.
    CHECK(bench.send({"80 00"}).substr(0, 8) == "80 00 00");
    CHECK(frames_of(bench, 1).empty());
    CHECK(bench.send({"30 00", "32 00", "06 00"}) == "30 FF FC 0D 32 E3 88 0D 06 86 00 0D");
    CHECK(bench.send({"83 02", "80 00"}).empty());  // No burst outside sampling.
}

TEST_CASE("answers in automatic sampling come between frames", "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    std::vector<std::byte> stream;
    for (int i = 0; i < 8; ++i) static_cast<void>(bench.machine.sample(kSample, stream));
    bench.machine.receive(bytes_of("02 00 0D"), bench.now, stream);
    static_cast<void>(bench.machine.sample(kSample, stream));
    REQUIRE(stream.size() == 24 + 4 + 24);
    CHECK(hex_of(std::span(stream).subspan(24, 4)) == "02 00 00 0D");
}

TEST_CASE("the delay of a frame is group delay, internal delay and wire time",
          "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    // 511/2 samples of 4 kHz, 430 us, 24 bytes of 10 bits at 460800 baud.
    CHECK(bench.machine.frame_delay() == 63'875'000ns + 430'000ns + 520'833ns);
}

TEST_CASE("the maker's Python logger gets through its handshake", "[sim][register_machine]") {
    // Order of accesses of py_esensorlib 2.1.0; every access is preceded by its window.
    Bench bench;
    bench.send({"FE 00", "83 02"});
    CHECK(bench.send({"FE 00", "4C 00"}) == "4C 53 45 0D");
    for (const auto& [command, answer] : {std::pair{"6A 00", "6A 33 41 0D"},
                                          {"6C 00", "6C 32 35 0D"},
                                          {"6E 00", "6E 44 41 0D"},
                                          {"70 00", "70 30 31 0D"},
                                          {"72 00", "72 00 0D 0D"},
                                          {"74 00", "74 31 30 0D"}}) {
        CHECK(bench.send({"FE 01", command}) == answer);
    }
    CHECK(bench.send({"FE 00", "83 02"}).empty());
    CHECK(bench.send({"FE 01", "02 00", "FE 01", "82 06", "FE 01", "02 00"}) ==
          "02 00 26 0D 02 00 06 0D");
    CHECK(bench.send({"FE 01", "00 00", "FE 01", "80 04", "FE 01", "00 00"}) ==
          "00 8E 04 0D 00 8E 04 0D");
    bench.send({"FE 01", "85 04", "FE 01", "86 08"});
    bench.now += 100ms;
    CHECK(bench.send({"FE 01", "06 00"}) == "06 00 08 0D");
    bench.send({"FE 01", "88 01", "FE 01", "8D C7", "FE 01", "8C 03"});
    CHECK(bench.send({"FE 01", "0C 00"}) == "0C C7 03 0D");
    bench.send({"FE 00", "83 01"});
    REQUIRE(bench.machine.is_sampling());
    CHECK(frames_of(bench, 33).size() == 2 * 24 * 3 - 1);
    bench.send({"FE 00", "83 02"});
    CHECK_FALSE(bench.machine.is_sampling());
}

TEST_CASE("the maker's C logger gets through its handshake", "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 00", "83 02", "FE 00", "02 00"}) == "02 04 00 0D");
    bench.now += 900ms;
    CHECK(bench.send({"FE 01", "0A 00"}) == "0A 00 00 0D");
    CHECK(bench.send({"FE 00", "04 00"}) == "04 00 00 0D");
    bench.send({"FE 01", "81 8E", "FE 01", "80 00", "FE 01", "82 06"});
    bench.send({"FE 01", "85 04", "FE 01", "86 07"});
    bench.now += 4ms;
    CHECK(bench.send({"FE 01", "06 00"}) == "06 00 07 0D");
    bench.send({"FE 01", "88 01", "FE 01", "8C 03", "FE 01", "8D C7"});
    CHECK(bench.send({"00 00", "02 00", "04 00", "0C 00"}) ==
          "00 8E 00 0D 02 00 06 0D 04 04 00 0D 0C C7 03 0D");
    bench.send({"FE 00", "83 01"});
    CHECK(bench.machine.is_sampling());
}

TEST_CASE("our own handshake brings the device into sampling, from streaming too",
          "[sim][register_machine]") {
    for (const bool was_streaming : {false, true}) {
        Bench bench("A351", {"A351AU10", "00000001", 1});
        if (was_streaming) bench.start_logging();
        wire::Handshake handshake(*wire::find_profile("A351"), {});
        std::vector<std::byte> line;  // What the device has answered and nobody has read.
        std::vector<std::byte> answer;
        std::optional<wire::DeviceIdentity> identity;
        for (int step = 0; step < 500 && !identity; ++step) {
            const wire::HandshakeStep next = handshake.next(answer);
            answer.clear();
            if (const auto* transmit = std::get_if<wire::Transmit>(&next)) {
                bench.machine.receive(transmit->bytes, bench.now, line);
                bench.now += transmit->pause_after;
            } else if (const auto* receive = std::get_if<wire::Receive>(&next)) {
                const auto count =
                    static_cast<std::ptrdiff_t>(std::min(receive->byte_count, line.size()));
                answer.assign(line.begin(), line.begin() + count);
                line.erase(line.begin(), line.begin() + count);
            } else if (const auto* drain = std::get_if<wire::DrainUntilSilent>(&next)) {
                line.clear();
                bench.now += drain->quiet;
            } else if (const auto* sampling = std::get_if<wire::Sampling>(&next)) {
                identity = sampling->identity;
            } else {
                FAIL(std::get<wire::HandshakeFailure>(next).reason);
            }
        }
        REQUIRE(identity);
        CHECK(identity->product_id == "A351AU10");
        CHECK(identity->has_expected_product_id);
        CHECK(bench.machine.is_sampling());
        CHECK(frames_of(bench, 8).size() == 24 * 3 - 1);
    }
}
