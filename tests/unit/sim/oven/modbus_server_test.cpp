#include "sim/oven/modbus_server.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include "tests/support/catch.hpp"

#include "fake_oven.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::oven;
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

/// A server and its clock.
struct Bench {
    FakeOven oven;
    oven::Controller controller{oven};
    ModbusServer server{controller};
    Nanoseconds now = 1h;

    /// Sends a request.  @return the bytes that come within 300 ms, the time-out of a patient host
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

/// Returns the number of requests in the report: each one raises one of these counters.
std::int64_t total(const oven::Report& report) {
    return report.answers + report.answers_lost + report.resets + report.broadcasts +
           report.for_other_units + report.unreadable + report.ignored +
           std::accumulate(report.faults.begin(), report.faults.end(), std::int64_t{0});
}

const Bytes kReadPv = bytes_of("01 03 20 00 00 01 8F CA");
const Bytes kPv = bytes_of("01 03 02 01 A9 79 AA");

}  // namespace

TEST_CASE("the golden conversation is answered byte for byte") {
    std::ifstream file(A351_GOLDEN "/oven/frames.txt");
    REQUIRE(file);
    Bench bench;
    int requests = 0;
    Bytes answer;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        CAPTURE(line);
        std::string hex = line.substr(1);
        std::erase_if(hex, [](char c) { return c == '[' || c == ']'; });
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

TEST_CASE("an answer is due after the line time of request and answer and a wait of 20 ms") {
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

TEST_CASE("a request in pieces is understood if the pauses are below 3.5 characters") {
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

TEST_CASE("requests are ignored after noise until there was silence, and while an answer is due") {
    Bench bench;
    bench.server.receive(bytes_of("01 03 FF 00 00 FF 00 55"), bench.now);
    bench.server.receive(kReadPv, bench.now + 1ms);
    CHECK(bench.wait(300ms).empty());
    CHECK(bench.server.report().unreadable == 1);
    bench.server.receive(kReadPv, bench.now);
    bench.server.receive(kReadPv, bench.now + 10ms);
    CHECK(bench.wait(300ms) == kPv);
    CHECK(bench.server.report().ignored == 1);
    Bytes twice = kReadPv;
    twice.insert(twice.end(), kReadPv.begin(), kReadPv.end());
    CHECK(bench.ask(twice) == kPv);
    CHECK(bench.server.report().ignored == 2);
    CHECK(bench.server.report().answers == 2);
}

TEST_CASE("bytes that are ignored in one run count once, however they are split") {
    // A byte takes 1.1 ms at 9600 baud; the answer is due after 37 ms.
    for (const std::size_t piece : {std::size_t{1}, std::size_t{3}, kReadPv.size()}) {
        CAPTURE(piece);
        Bench bench;
        const auto send_in_pieces = [&] {
            for (std::size_t at = 0; at < kReadPv.size(); at += piece) {
                bench.now += 1ms;
                bench.server.receive(
                    std::span(kReadPv).subspan(at, std::min(piece, kReadPv.size() - at)),
                    bench.now);
            }
        };
        bench.server.receive(kReadPv, bench.now);
        send_in_pieces();
        CHECK(bench.server.report().ignored == 1);
        bench.now += 5ms;
        send_in_pieces();  // Another one, after a silence.
        CHECK(bench.server.report().ignored == 2);
        CHECK(bench.wait(300ms) == kPv);
        bench.server.restart(bench.now);
        send_in_pieces();
        CHECK(bench.server.report().ignored == 3);
        CHECK(bench.server.report().answers == 1);
        CHECK(total(bench.server.report()) == 4);
    }
}

TEST_CASE("an answer is counted when it leaves or is lost") {
    Bench bench;
    bench.server.receive(kReadPv, bench.now);
    CHECK(total(bench.server.report()) == 0);
    CHECK(bench.wait(300ms) == kPv);
    CHECK(bench.server.report().answers == 1);

    bench.server.receive(kReadPv, bench.now);
    CHECK(bench.server.advance_to(bench.now + 300ms, false).empty());
    CHECK(bench.server.advance_to(bench.now + 300ms).empty());
    CHECK(bench.server.report().answers_lost == 1);

    bench.now += 1s;
    bench.server.fail_next(oven::Fault::crc_error, 1);
    bench.server.receive(kReadPv, bench.now);
    bench.server.restart(bench.now);
    CHECK(bench.wait(300ms).empty());
    CHECK(bench.server.report().answers_lost == 2);
    CHECK(bench.server.report().answers == 1);
    CHECK(total(bench.server.report()) == 3);

    bench.now += 10s;  // A request that is cut by a loss of power is ignored.
    bench.server.receive(std::span(kReadPv).first(5), bench.now);
    bench.server.restart(bench.now);
    bench.server.receive(std::span(kReadPv).subspan(5), bench.now + 1ms);
    CHECK(bench.wait(300ms).empty());
    CHECK(bench.server.report().ignored == 1);
    CHECK(total(bench.server.report()) == 4);
}

TEST_CASE("a software reset is counted once, and requested faults wait until the restart is over") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    bench.server.fail_next(oven::Fault::truncated, 1);
    Bytes reset_and_more = sealed(bytes_of("01 06 00 00 06 00"));
    reset_and_more.insert(reset_and_more.end(), kReadPv.begin(), kReadPv.end());
    CHECK(bench.ask(reset_and_more).empty());
    CHECK(bench.server.report().resets == 1);
    CHECK(bench.server.report().ignored == 1);
    CHECK(total(bench.server.report()) == 2);
    CHECK(bench.ask(kReadPv).empty());
    bench.now += 5s;
    // Communication writing was on in backup mode, so it is on again.
    CHECK((bench.controller.status() & oven_status::kWritingEnabled) != 0);
    CHECK(bench.ask(kReadPv) == bytes_of("01 03 02"));
    CHECK(bench.ask(kReadPv) == kPv);
    CHECK(total(bench.server.report()) == 5);
}

TEST_CASE("each fault spoils the requested number of answers in its own way") {
    Bench bench;
    const auto spoilt = [&bench](oven::Fault fault) {
        bench.server.fail_next(fault, 2);
        const Bytes first = bench.ask(kReadPv);
        CHECK(bench.ask(kReadPv) == first);
        CHECK(bench.ask(kReadPv) == kPv);
        CHECK(bench.server.report().faults[static_cast<std::size_t>(fault)] == 2);
        return first;
    };
    CHECK(spoilt(oven::Fault::silence).empty());
    CHECK(spoilt(oven::Fault::exception) == bytes_of("01 83 04 40 F3"));
    CHECK(spoilt(oven::Fault::crc_error) == bytes_of("01 03 02 01 A9 79 AB"));
    CHECK(spoilt(oven::Fault::truncated) == bytes_of("01 03 02"));
    const Bytes other = spoilt(oven::Fault::wrong_unit);
    CHECK(other.at(0) == std::byte{2});
    CHECK(is_sealed(other));
    const Bytes babble = spoilt(oven::Fault::babble);
    CHECK(babble.size() == 64);
    CHECK_FALSE(is_sealed(babble));
    // A delayed answer is right, but comes later than a host waits.
    bench.server.fail_next(oven::Fault::delay, 1);
    CHECK(bench.ask(kReadPv).empty());
    CHECK(bench.wait(1s) == kPv);
    CHECK(bench.ask(kReadPv) == kPv);
    // A fault without a limit is ended by a count of zero.
    bench.server.fail_next(oven::Fault::silence, -1);
    for (int i = 0; i < 20; ++i) CHECK(bench.ask(kReadPv).empty());
    bench.server.fail_next(oven::Fault::silence, 0);
    CHECK(bench.ask(kReadPv) == kPv);
}

TEST_CASE("a write lost in silence is not executed, a write with a spoilt answer is") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    const Bytes write = sealed(bytes_of("01 06 21 03 01 AE"));
    bench.server.fail_next(oven::Fault::silence, 1);
    CHECK(bench.ask(write).empty());
    CHECK(bench.oven.target == DegC(42.5));
    bench.server.fail_next(oven::Fault::crc_error, 1);
    CHECK_FALSE(is_sealed(bench.ask(write)));
    CHECK(bench.oven.target == DegC(43.0));
}

TEST_CASE("a controller set to another protocol answers no more") {
    Bench bench;
    REQUIRE(bench.controller.operate(0, 1) == std::nullopt);
    const Bytes setup = sealed(bytes_of("01 06 00 00 07 00"));
    const Bytes initialise = sealed(bytes_of("01 06 00 00 0B 00"));
    CHECK(bench.ask(setup) == setup);
    CHECK(bench.ask(initialise) == initialise);
    CHECK(bench.ask(kReadPv).empty());
}

TEST_CASE("every request is counted once") {
    Bench bench;
    CHECK(bench.ask(sealed(bytes_of("07 03 20 00 00 01"))).empty());
    CHECK(bench.ask(sealed(bytes_of("00 06 21 03 01 AE"))).empty());
    CHECK_FALSE(bench.ask(kReadPv).empty());
    CHECK_FALSE(bench.ask(sealed(bytes_of("01 04 20 00 00 01"))).empty());
    CHECK(bench.ask(bytes_of("01 03 20 00 00 01 00 00")).empty());
    CHECK(bench.ask(bytes_of("01 03 20 00")).empty());
    const oven::Report& report = bench.server.report();
    CHECK(report.for_other_units == 1);
    CHECK(report.broadcasts == 1);
    CHECK(report.answers == 2);
    CHECK(report.exceptions == 1);
    CHECK(report.unreadable == 2);
    CHECK(report.ignored == 0);
    // A valid CRC, but too short for the function.
    std::int64_t unreadable = 2;
    for (const char* begin : {"01 03", "01 10", "01 10 20", "01 10 21 03", "01 08 00 00 00"}) {
        CAPTURE(begin);
        CHECK(bench.ask(sealed(bytes_of(begin))).empty());
        CHECK(report.unreadable == ++unreadable);
        CHECK(bench.ask(kReadPv) == kPv);
    }
    CHECK(total(report) == 16);
}

TEST_CASE("frames with a valid CRC and any length and function count once, however they are split") {
    std::mt19937 random(7);
    Bench bench;
    std::int64_t sent = 0;
    const auto deliver = [&](const Bytes& frame, std::size_t first, std::size_t piece) {
        const std::span<const std::byte> all(frame);
        bench.server.receive(all.first(first), bench.now);
        for (std::size_t at = first; at < all.size(); at += piece) {
            bench.server.receive(all.subspan(at, std::min(piece, all.size() - at)), bench.now);
        }
        static_cast<void>(bench.server.advance_to(bench.now + 10ms));
        static_cast<void>(bench.server.advance_to(bench.now + 2s));
        bench.now += 3s;
        ++sent;
        if (total(bench.server.report()) == sent) return;
        CAPTURE(frame.size(), std::to_integer<int>(frame[1]), first, piece);
        REQUIRE(total(bench.server.report()) == sent);
    };
    for (std::size_t length = 4; length <= 264; ++length) {
        for (unsigned function = 0; function < 256; ++function) {
            Bytes frame(length - 2);
            for (std::byte& byte : frame) byte = static_cast<std::byte>(random() & 0xFF);
            // 0: all units, 1: this one, 2: another.
            frame[0] = static_cast<std::byte>(random() % 3);
            frame[1] = static_cast<std::byte>(function);
            frame = sealed(std::move(frame));
            deliver(frame, length, 1);
            deliver(frame, 1, 1);
            deliver(frame, 1, 7);
            for (std::size_t cut = 1; cut < std::min<std::size_t>(length, 16); ++cut) {
                deliver(frame, cut, length);
            }
            deliver(frame, 1 + random() % (length - 1), length);
        }
    }
    const oven::Report& report = bench.server.report();
    CHECK(report.answers > 1000);
    CHECK(report.broadcasts > 1000);
    CHECK(report.for_other_units > 1000);
    CHECK(report.unreadable > 1000);
}
