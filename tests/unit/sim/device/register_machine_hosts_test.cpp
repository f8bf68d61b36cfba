#include "tests/support/catch.hpp"

#include "protocol/wire/handshake.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

TEST_CASE("the handshake of the maker's Python logger succeeds", "[sim][register_machine]") {
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
    CHECK(bench.sample(33).size() == 2 * 24 * 3 - 1);
    bench.send({"FE 00", "83 02"});
    CHECK_FALSE(bench.machine.is_sampling());
}

TEST_CASE("the handshake of the maker's C logger succeeds", "[sim][register_machine]") {
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

TEST_CASE("our own handshake starts sampling, even if the device is already streaming",
          "[sim][register_machine]") {
    for (const bool was_streaming : {false, true}) {
        Bench bench("A351", {"A351AU10", "00000001", 1});
        if (was_streaming) bench.start_logging();
        wire::Handshake handshake(*wire::find_profile("A351"), {});
        std::vector<std::byte> line;  // Answers of the device that have not been read yet.
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
        CHECK(bench.sample(8).size() == 24 * 3 - 1);
    }
}
