#include "sim/oven/modbus_server.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>
#include <string>

#include "fake_oven.hpp"

using namespace a351;
using namespace a351::sim;
using namespace std::chrono_literals;

namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(const std::string& hex) {
    Bytes bytes;
    std::istringstream words(hex);
    for (std::string word; words >> word;) {
        bytes.push_back(static_cast<std::byte>(std::stoi(word, nullptr, 16)));
    }
    return bytes;
}

/// A server and the time it lives in.
struct Bench {
    FakeOven oven;
    OvenController controller{oven};
    ModbusServer server;
    Nanoseconds now = 1h;

    explicit Bench(const ServerOptions& options = {}) : server(controller, options) {}

    /// What comes back within 300 ms, the time-out of a patient host.
    Bytes ask(const Bytes& request) {
        server.receive(request, now);
        return wait(300ms);
    }

    Bytes wait(Nanoseconds duration) {
        Bytes heard;
        for (const Nanoseconds end = now + duration; now < end; now += 1ms) {
            const Bytes part = server.advance_to(now);
            heard.insert(heard.end(), part.begin(), part.end());
        }
        return heard;
    }
};

const Bytes kReadPv = bytes_of("01 03 20 00 00 01 8F CA");
const Bytes kPv = bytes_of("01 03 02 01 A9 79 AA");

}  // namespace

TEST_CASE("the golden conversation comes out byte for byte", "[sim][modbus_server]") {
    std::ifstream file(A351_GOLDEN "/oven/frames.txt");
    REQUIRE(file);
    Bench bench;
    int requests = 0;
    Bytes answer;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        CAPTURE(line);
        std::string hex = line.substr(1);
        hex.erase(
            std::remove_if(hex.begin(), hex.end(), [](char c) { return c == '[' || c == ']'; }),
            hex.end());
        if (line[0] == '<') {
            CHECK(answer == bytes_of(hex));
            continue;
        }
        ++requests;
        const std::size_t pause = hex.find('|');
        if (pause != std::string::npos) {
            bench.server.receive(bytes_of(hex.substr(0, pause)), bench.now);
            CHECK(bench.wait(30ms).empty());
            hex.erase(0, pause + 1);
        }
        answer = bench.ask(bytes_of(hex));
    }
    CHECK(requests == 41);
}

TEST_CASE("request and answer take their time, and between them lies the wait",
          "[sim][modbus_server]") {
    Bench bench;
    const Nanoseconds start = bench.now;
    bench.server.receive(kReadPv, start);
    // 8 + 7 characters of 11 bits at 9600 baud, and 20 ms.
    const Nanoseconds due = start + from_seconds(15 * 11 / 9600.0) + 20ms;
    REQUIRE(bench.server.next_due() == due);
    CHECK(bench.server.advance_to(due - 1ns).empty());
    CHECK(bench.server.advance_to(due) == kPv);
    CHECK(bench.server.next_due() == std::nullopt);
}

TEST_CASE("a request in pieces is understood while the pauses are short", "[sim][modbus_server]") {
    // 3.5 characters at 9600 baud are 4.01 ms.
    for (const auto& [pause, is_understood] :
         {std::pair{Nanoseconds(4ms), true}, {4100us, false}}) {
        for (std::size_t cut = 1; cut < kReadPv.size(); ++cut) {
            CAPTURE(cut, pause.count());
            Bench bench;
            const std::span<const std::byte> all(kReadPv);
            bench.server.receive(all.first(cut), bench.now);
            bench.now += pause;
            bench.server.receive(all.subspan(cut), bench.now);
            CHECK(bench.wait(300ms) == (is_understood ? kPv : Bytes{}));
            CHECK(bench.ask(kReadPv) == kPv);
        }
    }
}

TEST_CASE("after noise nothing is heard until there was silence", "[sim][modbus_server]") {
    Bench bench;
    bench.server.receive(bytes_of("01 03 FF 00 00 FF 00 55"), bench.now);
    bench.server.receive(kReadPv, bench.now + 1ms);
    CHECK(bench.wait(300ms).empty());
    CHECK(bench.server.report().unreadable == 1);
    CHECK(bench.ask(kReadPv) == kPv);
}

TEST_CASE("while an answer is due nothing is heard", "[sim][modbus_server]") {
    Bench bench;
    bench.server.receive(kReadPv, bench.now);
    bench.server.receive(kReadPv, bench.now + 10ms);
    CHECK(bench.wait(300ms) == kPv);
    CHECK(bench.server.report().unheard == 1);
    Bytes twice = kReadPv;
    twice.insert(twice.end(), kReadPv.begin(), kReadPv.end());
    CHECK(bench.ask(twice) == kPv);
    CHECK(bench.server.report().unheard == 2);
    CHECK(bench.server.report().answers == 2);
}

TEST_CASE("each fault spoils as many answers as asked for, in its own way",
          "[sim][modbus_server]") {
    Bench bench;
    const auto spoilt = [&bench](OvenFault fault) {
        bench.server.fail_next(fault, 2);
        const Bytes first = bench.ask(kReadPv);
        CHECK(bench.ask(kReadPv) == first);
        CHECK(bench.ask(kReadPv) == kPv);
        CHECK(bench.server.report().faults[static_cast<std::size_t>(fault)] == 2);
        return first;
    };
    CHECK(spoilt(OvenFault::silence).empty());
    CHECK(spoilt(OvenFault::exception) == bytes_of("01 83 04 40 F3"));
    CHECK(spoilt(OvenFault::crc_error) == bytes_of("01 03 02 01 A9 79 AB"));
    CHECK(spoilt(OvenFault::truncated) == bytes_of("01 03 02"));
    const Bytes other = spoilt(OvenFault::wrong_unit);
    CHECK(other.at(0) == std::byte{2});
    CHECK(is_sealed(other));
    const Bytes babble = spoilt(OvenFault::babble);
    CHECK(babble.size() == 64);
    CHECK_FALSE(is_sealed(babble));
}

TEST_CASE("a delayed answer is right, but later than a host waits", "[sim][modbus_server]") {
    Bench bench;
    bench.server.fail_next(OvenFault::delay, 1);
    CHECK(bench.ask(kReadPv).empty());
    CHECK(bench.wait(1s) == kPv);
    CHECK(bench.ask(kReadPv) == kPv);
}

TEST_CASE("a fault without end is ended by zero", "[sim][modbus_server]") {
    Bench bench;
    bench.server.fail_next(OvenFault::silence, -1);
    for (int i = 0; i < 20; ++i) CHECK(bench.ask(kReadPv).empty());
    bench.server.fail_next(OvenFault::silence, 0);
    CHECK(bench.ask(kReadPv) == kPv);
}

TEST_CASE("a spoilt write: silence has not executed it, a lost answer has",
          "[sim][modbus_server]") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    const Bytes write = sealed(bytes_of("01 06 21 03 01 AE"));
    bench.server.fail_next(OvenFault::silence, 1);
    CHECK(bench.ask(write).empty());
    CHECK(bench.oven.target == DegC(42.5));
    bench.server.fail_next(OvenFault::crc_error, 1);
    CHECK_FALSE(is_sealed(bench.ask(write)));
    CHECK(bench.oven.target == DegC(43.0));
}

TEST_CASE("a software reset is not answered, and takes its time", "[sim][modbus_server]") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    CHECK(bench.ask(sealed(bytes_of("01 06 00 00 06 00"))).empty());
    CHECK(bench.ask(kReadPv).empty());
    bench.now += 5s;
    CHECK(bench.ask(kReadPv) == kPv);
    // Communication writing was on in backup mode, so it is on again.
    CHECK((bench.controller.status() & oven_status::kWritingEnabled) != 0);
}

TEST_CASE("a controller set back to another protocol says nothing more", "[sim][modbus_server]") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    const Bytes setup = sealed(bytes_of("01 06 00 00 07 00"));
    const Bytes initialise = sealed(bytes_of("01 06 00 00 0B 00"));
    CHECK(bench.ask(setup) == setup);
    CHECK(bench.ask(initialise) == initialise);
    CHECK(bench.ask(kReadPv).empty());
}

TEST_CASE("every request is counted once", "[sim][modbus_server]") {
    Bench bench({.unit = 7});
    CHECK(bench.ask(kReadPv).empty());
    CHECK(bench.ask(sealed(bytes_of("00 06 21 03 01 AE"))).empty());
    CHECK_FALSE(bench.ask(sealed(bytes_of("07 03 20 00 00 01"))).empty());
    CHECK_FALSE(bench.ask(sealed(bytes_of("07 04 20 00 00 01"))).empty());
    CHECK(bench.ask(bytes_of("07 03 20 00 00 01 00 00")).empty());
    CHECK(bench.ask(bytes_of("07 03 20 00")).empty());
    const OvenReport& report = bench.server.report();
    CHECK(report.for_other_units == 1);
    CHECK(report.broadcasts == 1);
    CHECK(report.answers == 2);
    CHECK(report.exceptions == 1);
    CHECK(report.unreadable == 2);
    CHECK(report.unheard == 0);
}
