#include "sim/line/fault_script.hpp"

#include <chrono>
#include <filesystem>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "sim/line/control_socket.hpp"

using namespace a351;
using namespace a351::sim::line;
using namespace std::chrono_literals;

namespace {

const UtcTime kStart = *parse_rfc3339("2017-07-16T00:00:00Z");
const FaultRules kRules{*wire::find_profile("A351"), 20.0, {"oven_silence"}};

FaultScript parse(const std::string& toml) {
    return parse_fault_script(toml, "faults.toml", kStart, kRules);
}

}  // namespace

TEST_CASE("every kind of fault can be given in a script and in words") {
    for (const std::string_view kind : fault_kinds()) {
        CAPTURE(kind);
        if (kind == "overrun") continue;
        std::string keys, words(kind);
        if (kind == "other_unit") keys = "serial_number = \"12345678\"";
        if (kind == "other_unit") words += " serial_number=12345678";
        if (kind == "change_settings") keys = "output_rate_hz = 100";
        if (kind == "change_settings") words += " output_rate_hz=100";
        const FaultScript script =
            parse("[[fault]]\nkind = \"" + std::string(kind) + "\"\nat_s = 1\n" + keys);
        REQUIRE(script.planned.size() == 1);
        CHECK(script.planned[0].fault.name == kind);
        CHECK(static_cast<std::size_t>(script.planned[0].fault.kind) ==
              static_cast<std::size_t>(std::ranges::find(fault_kinds(), kind) -
                                       fault_kinds().begin()));
        CHECK(parse_fault(words, kRules).kind == script.planned[0].fault.kind);
    }
}

TEST_CASE("times in seconds, UTC or frames, and rates and seed of random faults are read") {
    const FaultScript script = parse(
        "answers_cut_frames = true\n[random]\nseed = 9\nflip_bit_per_h = 12.5\n"
        "oven_silence_per_h = 1\n"
        "[[fault]]\nkind = \"reset\"\nat_s = 2.5\n"
        "[[fault]]\nkind = \"reset\"\nat_utc = \"2017-07-16T00:00:03Z\"\n"
        "[[fault]]\nkind = \"reset\"\nat_frame = 7\n");
    CHECK(script.planned[0].at == kStart + 2500ms);
    CHECK(script.planned[1].at == kStart + 3s);
    CHECK(script.planned[2].at_frame == 7);
    CHECK_FALSE(script.planned[2].at);
    CHECK(script.seed == 9);
    CHECK(script.answers_cut_frames);
    REQUIRE(script.random.size() == 2);
    CHECK(script.random[0].fault.kind == FaultKind::flip_bit);
    CHECK(script.random[0].per_h == 12.5);
    CHECK(script.random[1].fault.name == "oven_silence");
}

TEST_CASE("an error in a fault script is reported with file, line, key, value and what is allowed") {
    const auto refused = [](const std::string& toml, std::initializer_list<const char*> parts) {
        CAPTURE(toml);
        try {
            static_cast<void>(parse(toml));
            FAIL("was taken");
        } catch (const InputError& error) {
            for (const char* part : parts) CHECK_THAT(error.what(), ContainsSubstring(part));
            CHECK_THAT(error.what(), !ContainsSubstring("\n"));
        }
    };
    const std::string head = "[[fault]]\nkind = \"flip_bit\"\n";
    refused(head, {"faults.toml:", "no instant", "at_s, at_utc, at_frame"});
    refused(head + "at_s = 1\nat_frame = 2", {"several instants"});
    refused(head + "at_s = -1", {"faults.toml:3", "fault.at_s = -1", "allowed"});
    refused(head + "at_utc = \"noon\"", {"faults.toml:3", "noon", "RFC 3339"});
    refused(head + "at_s = 1\nbits = 17", {"faults.toml:4", "fault.bits = 17", "from 1 to 16"});
    refused(head + "at_s = 1\nseconds = 1", {"faults.toml:4", "seconds", "unknown key", "bits"});
    refused("[[fault]]\nkind = \"melt\"\nat_s = 1", {"faults.toml:2", "melt", "flip_bit"});
    refused("[[fault]]\nkind = \"oven_melt\"\nat_s = 1", {"oven_melt", "oven_silence"});
    refused("[[fault]]\nkind = \"change_baud\"\nat_s = 1\nbaud = 9600",
            {"faults.toml:4", "9600", "460800"});
    refused("[[fault]]\nkind = \"change_settings\"\nat_s = 1\noutput_rate_hz = 51", {"51", "50"});
    refused("[[fault]]\nkind = \"change_settings\"\nat_s = 1\nfilter = \"k1\"", {"k1", "k512_fc9"});
    refused("[[fault]]\nkind = \"change_settings\"\nat_s = 1\nburst_ctrl = 3", {"burst_ctrl = 3"});
    refused("[[fault]]\nkind = \"change_settings\"\nat_s = 1", {"changes nothing"});
    refused("[[fault]]\nkind = \"other_unit\"\nat_s = 1\nserial_number = \"1\"", {"eight"});
    refused("[random]\noverrun_per_h = 1", {"faults.toml:2", "unknown key"});
    refused("[random]\nreset_per_h = -1", {"random.reset_per_h = -1"});
    refused("[[fualt]]\nkind = \"reset\"", {"fualt", "unknown key", "fault"});
    refused("kind =", {"faults.toml:1", "not TOML"});
}

TEST_CASE("an overrun is allowed only up to 50 times real time") {
    FaultRules rules = kRules;
    rules.speed = 50.0;
    CHECK(parse_fault("overrun", rules).kind == FaultKind::overrun);
    rules.speed = 50.1;
    CHECK_THROWS_WITH(parse_fault("overrun", rules), ContainsSubstring("up to 50"));
}

TEST_CASE("words that are not a fault are refused in one line") {
    for (const std::string words :
         {"", "  ", "melt", "flip_bit 3", "flip_bit count", "flip_bit count=", "flip_bit =3",
          "flip_bit count=3 count=4", "flip_bit count=x", "flip_bit count=[1]",
          "flip_bit count=\"3", "reset]\n[x", "flip_bit count=3#", "flip_bit a.b=3"}) {
        CAPTURE(words);
        try {
            static_cast<void>(parse_fault(words, kRules));
            FAIL("was taken");
        } catch (const InputError& error) {
            CHECK_THAT(error.what(), !ContainsSubstring("\n"));
        }
    }
    const Fault fault = parse_fault("  hang_up   seconds=2.5 loses_power=true", kRules);
    CHECK(fault.seconds == 2.5);
    CHECK(fault.loses_power);
}

TEST_CASE("the example script is read") {
    const auto example = std::filesystem::path(A351_GOLDEN).parent_path().parent_path() /
                         "config/faults/example.toml";
    const FaultScript script = read_fault_script(example, kStart, kRules);
    CHECK(script.planned.size() > 20);
    CHECK(script.random.size() > 1);
}

TEST_CASE("each order of the control socket starts its action") {
    std::string done;
    const ControlActions actions{[] { return std::string("{}"); }, [&done] { done = "edge"; },
                                 [&done] { done = "quit"; },
                                 [&done](const Fault& fault) { done = fault.name; }};
    CHECK(execute("status", actions, kRules) == "{}");
    CHECK(execute("edge", actions, kRules).empty());
    CHECK(done == "edge");
    CHECK(execute("quit", actions, kRules).empty());
    CHECK(done == "quit");
    CHECK(execute("lose_frames count=3", actions, kRules).empty());
    CHECK(done == "lose_frames");
    CHECK_THROWS_AS(execute("explode", actions, kRules), InputError);
}
