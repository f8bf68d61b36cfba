#include "daemon/source/oven_link.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>
#include <vector>
#include "daemon/source/port.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/fake_controller.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"

using namespace a351;
using namespace a351::daemon::source;
using journal::OvenChunk;
using journal::OvenOutcome;
using Manner = FakeController::Manner;
using State = OvenLinkStatus::State;

namespace {

/// A link to a fake controller, with the polls that it delivers.
class OvenRig {
public:
    FakeController controller;

    explicit OvenRig(std::filesystem::path port = {})
        : link({.line = {.port = port.empty() ? std::filesystem::path(controller.path()) : port,
                         .parity = 'N'},
                .decimals = 1},
               clock_, [this](OvenChunk poll) {
                   const std::lock_guard lock(mutex_);
                   polls_.push_back(std::move(poll));
               }) {}

    [[nodiscard]] std::vector<OvenChunk> polls() const {
        const std::lock_guard lock(mutex_);
        return polls_;
    }
    [[nodiscard]] std::uint64_t count(OvenOutcome outcome) const {
        return link.status().polls.at(static_cast<std::size_t>(outcome));
    }
    [[nodiscard]] bool reaches(OvenOutcome outcome, std::uint64_t more = 1) const {
        const auto before = count(outcome);
        return eventually([&] { return count(outcome) >= before + more; });
    }

private:
    // A fast clock makes the pauses between attempts short.
    HostClock clock_{ClockScale{1000.0, *parse_rfc3339("2026-03-01T00:00:00Z"), host_realtime()}};
    mutable std::mutex mutex_;
    std::vector<OvenChunk> polls_;

public:
    OvenLink link;  // Declared last, so that its thread ends first.
};

}  // namespace

TEST_CASE("a controller is polled for its values, once for its decimals and for nothing else") {
    OvenRig rig;
    CHECK(rig.link.status().is_stale);
    CHECK_FALSE(rig.link.status().age);
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered, 3));
    const auto status = rig.link.status();
    rig.link.stop();

    CHECK(status.state == State::answering);
    CHECK(status.trouble.empty());
    CHECK(status.port == rig.controller.path() + ", 9600 baud 8N2");
    REQUIRE(status.values);
    CHECK(status.values->process_value == DegC(42.5));
    CHECK(status.values->set_point == DegC(42.5));
    CHECK(status.values->heating == Percent(25.0));
    CHECK(status.values->status == 0x0100);
    CHECK(status.age);
    CHECK_FALSE(status.is_stale);

    const auto polls = rig.polls();
    CHECK(polls.size() == static_cast<std::size_t>(rig.controller.polls));
    for (const OvenChunk& poll : polls) {
        CHECK(poll.outcome == OvenOutcome::answered);
        CHECK(poll.decimals == 1);
        CHECK(poll.registers == std::vector<std::uint16_t>{425, 0x0100, 425, 0, 250});
    }
    for (std::size_t i = 1; i < polls.size(); ++i) CHECK(polls[i].time > polls[i - 1].time);
    CHECK(rig.controller.decimal_requests == 1);
    CHECK(rig.controller.other_requests == 0);
}

TEST_CASE("each kind of failed answer has its own counter, and the next answer is accepted") {
    const auto [manner, outcome] =
        GENERATE(table<Manner, OvenOutcome>({{Manner::mute, OvenOutcome::timed_out},
                                             {Manner::half, OvenOutcome::timed_out},
                                             {Manner::bad_crc, OvenOutcome::bad_crc},
                                             {Manner::babble, OvenOutcome::bad_crc},
                                             {Manner::own_babble, OvenOutcome::bad_crc},
                                             {Manner::refused, OvenOutcome::exception},
                                             {Manner::other_unit, OvenOutcome::other_unit},
                                             {Manner::other_question, OvenOutcome::malformed}}));
    CAPTURE(static_cast<int>(manner));
    OvenRig rig;
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered));
    rig.controller.manner = manner;
    REQUIRE(rig.reaches(outcome, 2));
    rig.controller.manner = Manner::good;
    REQUIRE(rig.reaches(OvenOutcome::answered));
    CHECK(rig.link.status().state == State::answering);
    rig.link.stop();

    std::array<std::uint64_t, journal::kOvenOutcomeCount> handed_on{};
    for (const OvenChunk& poll : rig.polls()) {
        ++handed_on.at(static_cast<std::size_t>(poll.outcome));
        CHECK(poll.registers.empty() == (poll.outcome != OvenOutcome::answered));
    }
    CHECK(handed_on == rig.link.status().polls);
    CHECK(rig.count(OvenOutcome::answered) + rig.count(outcome) == rig.polls().size());
    // After each refusal the link tries the addresses of four-byte mode.
    const auto refused = manner == Manner::refused ? rig.count(OvenOutcome::exception) : 0;
    CHECK(rig.controller.other_requests == static_cast<int>(refused));
}

TEST_CASE("one lost answer does not change the state, but a last answer that is too old does") {
    OvenRig rig;
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered));
    rig.controller.manner = Manner::mute;
    REQUIRE(rig.reaches(OvenOutcome::timed_out));
    auto status = rig.link.status();
    CHECK((status.state == State::answering || status.is_stale));
    CHECK(status.trouble == "no answer in time");

    REQUIRE(eventually([&] { return rig.link.status().state == State::silent; }));
    status = rig.link.status();
    CHECK(status.is_stale);
    REQUIRE(status.values);  // The last values remain, and their age shows that they are old.
    CHECK(status.values->process_value == DegC(42.5));
}

TEST_CASE("the controller's own decimals override the configured ones") {
    OvenRig rig;
    rig.controller.decimals = 2;
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered));
    CHECK(rig.link.status().decimals == 2);
    CHECK(rig.link.status().values->process_value == DegC(4.25));
    CHECK(rig.polls().front().decimals == 2);
}

TEST_CASE(
    "without usable decimals of the controller the configured ones apply, and no value is lost") {
    OvenRig rig;
    SECTION("no such register") { rig.controller.decimals_manner = Manner::refused; }
    SECTION("an impossible number") { rig.controller.decimals = 425; }
    SECTION("no answer") { rig.controller.decimals_manner = Manner::mute; }
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered, 5));
    rig.link.stop();
    CHECK(rig.controller.decimal_requests <= 3);
    CHECK(rig.count(OvenOutcome::answered) == rig.polls().size());
    for (const OvenChunk& poll : rig.polls()) CHECK(poll.decimals == 1);
}

TEST_CASE("a controller in four-byte mode is read, and recorded like one in two-byte mode") {
    OvenRig rig;
    rig.controller.is_four_byte = true;
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::answered, 5));
    const auto status = rig.link.status();
    CHECK(status.values->process_value == DegC(-1.5));
    CHECK(status.values->set_point == DegC(42.5));
    CHECK(status.decimals == 1);
    CHECK(rig.polls().back().registers == std::vector<std::uint16_t>{0xFFF1, 0x0100, 425, 0, 250});
    CHECK(rig.controller.other_requests == 1);  // 2000h, once

    // A controller in two-byte mode takes its place.
    rig.controller.is_four_byte = false;
    REQUIRE(rig.reaches(OvenOutcome::answered, 5));
    CHECK(rig.link.status().values->process_value == DegC(42.5));
}

TEST_CASE("a link that is being stopped sends no second request") {
    bool is_left_alone = false;
    // Several tries, because a busy host may stop it only after the answer.
    for (int i = 0; i < 5 && !is_left_alone; ++i) {
        OvenRig rig;
        rig.controller.manner = Manner::refused;  // A running link would now try four-byte mode.
        rig.controller.delay = ModbusLine::kResponseTimeout / 2;
        rig.link.start();
        REQUIRE(eventually([&] { return rig.controller.polls > 0; }));
        rig.link.stop();
        is_left_alone =
            rig.count(OvenOutcome::exception) == 1 && rig.controller.other_requests == 0;
    }
    CHECK(is_left_alone);
}

TEST_CASE("a controller that comes back under another name is found through its link") {
    const test::TemporaryDirectory directory;
    const auto port = directory.path() / "oven";
    OvenRig rig(port);
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::no_port));
    CHECK(rig.link.status().state == State::searching);
    CHECK(rig.link.status().port.empty());

    std::filesystem::create_symlink(rig.controller.path(), port);
    REQUIRE(rig.reaches(OvenOutcome::answered));
    rig.controller.switch_off();
    REQUIRE(rig.reaches(OvenOutcome::no_port));
    CHECK(rig.link.status().state == State::searching);

    FakeController other;
    std::filesystem::remove(port);
    std::filesystem::create_symlink(other.path(), port);
    REQUIRE(rig.reaches(OvenOutcome::answered));
    CHECK(rig.link.status().port.starts_with(other.path() + ","));
    rig.link.stop();
}

TEST_CASE("a port is used by one link at a time") {
    OvenRig rig;
    const auto sensor = open_port({rig.controller.path(), {}}, 460800);
    rig.link.start();
    REQUIRE(rig.reaches(OvenOutcome::no_port));
    CHECK(rig.link.status().trouble == rig.controller.path() + ": in use by another process");
    CHECK(rig.controller.polls == 0);
    rig.link.stop();

    const FakeController other;
    const ModbusLine::Settings settings{.port = other.path(), .parity = 'N'};
    const ModbusLine line(settings);
    CHECK_THROWS_AS(ModbusLine(settings), PortError);
    CHECK_THROWS_AS(open_port({other.path(), {}}, 460800), PortError);
}

TEST_CASE("leftover bytes of one answer are not taken for the next answer") {
    FakeController controller;
    ModbusLine line({.port = controller.path(), .parity = 'N'});
    controller.manner = Manner::babble;  // libmodbus reads eight of its 64 bytes.
    CHECK(line.read(oven::kFirstMonitor.two_byte, oven::kMonitorCount).outcome ==
          OvenOutcome::bad_crc);
    controller.manner = Manner::good;
    CHECK(line.read(oven::kFirstMonitor.two_byte, oven::kMonitorCount).words.size() ==
          oven::kMonitorCount);
}

TEST_CASE("opening a port turns its echo off, also for the time after it is closed") {
    Pty pty;
    const int host = open(pty.path().c_str(), O_RDWR | O_NOCTTY);
    termios settings{};
    REQUIRE(tcgetattr(host, &settings) == 0);
    REQUIRE((settings.c_lflag & ECHO) != 0);
    { const ModbusLine line({.port = pty.path(), .parity = 'N'}); }
    REQUIRE(tcgetattr(host, &settings) == 0);
    close(host);
    CHECK((settings.c_lflag & (ECHO | ICANON)) == 0);
}

TEST_CASE("a path that is not a port, and a port that does not accept the settings, are refused") {
    // A pseudo-terminal has no parity, and ignores a request for it without an error.
    const Pty pty;
    CHECK_NOTHROW(ModbusLine({.port = pty.path(), .parity = 'N'}));
    CHECK_THROWS_WITH(
        ModbusLine({.port = pty.path(), .parity = 'N', .is_rs485 = true}),
        EndsWith("the port's driver cannot switch an RS-485 line; set rs485 = false"));
    CHECK_THROWS_WITH(
        ModbusLine({.port = pty.path(), .parity = 'E'}),
        EndsWith("baud 8E1: the port does not keep this parity; use another parity or port"));
    CHECK_THROWS_AS(ModbusLine({.port = "/dev/null"}), PortError);
    CHECK_THROWS_AS(ModbusLine({.port = "/nonexistent/oven"}), PortError);
}
