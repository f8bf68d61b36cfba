#include "daemon/source/sensor_link.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>
#include "protocol/wire/burst_decoder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"

using namespace a351;
using namespace a351::daemon::source;

namespace {

LinkOptions options_for(const std::filesystem::path& path) {
    LinkOptions options;
    options.address.path = path;
    options.profile = wire::find_profile("A351");
    options.header.profile = "A351";
    options.header.output_rate_hz = 50;
    options.header.burst_ctrl = options.settings.layout.burst_ctrl();
    options.header.baud = options.baud;
    return options;
}

/// A fake sensor, and everything that a link to it needs.
struct LinkRig {
    FakeSensor sensor;
    ReadQueue queue;
    HostClock clock;
    LinkOptions options = options_for(sensor.path());
};

/// Ten seconds of instrument time in one of real time.
struct FastLinkRig : LinkRig {
    FastLinkRig() { clock = HostClock(ClockScale{10.0, host_realtime(), host_realtime()}); }
};

/// Returns a stream whose last received frame is frame `count` / 80 - 1 of a FakeSensor, now.
journal::StreamEnd known_stream(const LinkOptions& options, const HostClock& clock,
                                std::uint16_t count) {
    journal::StreamEnd known{options.header, count, clock.raw()};
    known.header.session.bytes[0] = 42;
    known.header.serial_number = "00000042";
    known.header.port = options.address.to_text();
    return known;
}

/// Everything that came through the queue.
struct Received {
    std::vector<journal::Header> sessions;
    std::vector<std::byte> bytes;
    std::vector<std::byte> sent;
    bool do_stamps_ascend = true;

    explicit Received(ReadQueue& queue) {
        RawTime last;
        for (auto item = queue.front(); item; item = queue.front()) {
            if (item->kind == ReadQueue::Kind::session) sessions.push_back(queue.take_session());
            auto& into = item->kind == ReadQueue::Kind::tx ? sent : bytes;
            into.insert(into.end(), item->bytes.begin(), item->bytes.end());
            if (item->kind == ReadQueue::Kind::rx) {
                if (item->time < last) do_stamps_ascend = false;
                last = item->time;
            }
            queue.pop();
        }
    }

    [[nodiscard]] std::vector<wire::BurstValues> frames() const {
        std::vector<wire::BurstValues> frames;
        wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
        std::span<const std::byte> input(bytes);
        while (const auto event = decoder.next(input)) {
            if (const auto* frame = std::get_if<wire::BurstFrame>(&*event))
                frames.push_back(frame->values());
        }
        return frames;
    }
};

}  // namespace

TEST_CASE_METHOD(
    LinkRig,
    "the link configures the sensor, records from the first frame and stops it at the end") {
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 20; }));
    CHECK(link.status().state == LinkStatus::State::sampling);
    CHECK(link.status().trouble.empty());
    link.stop();
    CHECK(eventually([&] { return !sensor.is_sampling(); }));
    CHECK(link.status().state == LinkStatus::State::stopped);

    const Received received(queue);
    REQUIRE(received.sessions.size() == 1);
    CHECK(received.sessions[0].serial_number == "00000042");
    CHECK(received.sessions[0].product_id == "A351AU10");
    CHECK(received.sessions[0].output_rate_hz == 50);
    CHECK(received.do_stamps_ascend);
    CHECK_FALSE(received.sent.empty());
    const auto frames = received.frames();
    REQUIRE(frames.size() >= 20);
    std::int32_t wrong = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (frames[i] != FakeSensor::values(static_cast<std::int32_t>(i))) ++wrong;
    }
    CHECK(wrong == 0);
    // The decoder holds the last frame back until another confirms it.
    CHECK(frames.size() + 1 >= static_cast<std::size_t>(sensor.frames_sent));
}

TEST_CASE_METHOD(
    FastLinkRig,
    "a sensor that falls silent and lost its power is configured again, as a new session") {
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 5; }));
    sensor.is_mute = true;
    REQUIRE(eventually([&] { return link.status().stalls == 1; }));
    CHECK(eventually([&] { return link.status().state == LinkStatus::State::waiting; }));
    CHECK(link.status().trouble == "the sensor does not answer; check its plug and its power");
    sensor.lose_power();
    sensor.is_mute = false;
    REQUIRE(eventually([&] { return link.status().sessions == 2; }));
    link.stop();
    const Received received(queue);
    REQUIRE(received.sessions.size() == 2);
    CHECK(received.sessions[0].session != received.sessions[1].session);
}

TEST_CASE_METHOD(LinkRig,
                 "a loose plug at the sensor costs the samples of the outage and no session") {
    // The outage ends while the link listens, configures, tries other baud rates, or waits.
    const std::chrono::milliseconds outage(GENERATE(2300, 3200, 5400, 9000));
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 50; }));
    sensor.is_loose = true;
    std::this_thread::sleep_for(outage);
    const LinkStatus::State state = link.status().state;
    const std::string trouble = link.status().trouble;
    const std::int32_t lost_until = sensor.frames_sent;
    const auto back = std::chrono::steady_clock::now();
    sensor.is_loose = false;
    REQUIRE(eventually([&] { return link.status().state == LinkStatus::State::sampling; }));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - back;
    REQUIRE(eventually([&] { return sensor.frames_sent >= lost_until + 100; }));
    link.stop();
    const Received received(queue);
    const auto frames = received.frames();
    const auto is_late = [&](const wire::BurstValues& frame) {
        return frame.axes[0] >= lost_until;
    };
    const auto first = std::ranges::find_if(frames, is_late);
    REQUIRE(first != frames.end());
    std::printf(
        "loose for %.1f s (%s: %s): sampling %.2f s after the plug is back, %d frames unread\n",
        std::chrono::duration<double>(outage).count(), to_text(state), trouble.c_str(),
        took.count(), first->axes[0] - lost_until);
    CHECK(took.count() < 1.0);
    CHECK(first->axes[0] - lost_until < 50);
    CHECK(link.status().sessions == 1);
    CHECK(link.status().adoptions == 1);
    REQUIRE(received.sessions.size() == 2);
    CHECK(received.sessions[0].session == received.sessions[1].session);
}

TEST_CASE_METHOD(FastLinkRig, "a sensor whose bytes are no frames is configured again") {
    sensor.does_babble = true;
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return link.status().stalls == 1; }));
    sensor.does_babble = false;
    REQUIRE(eventually([&] { return link.status().sessions == 2; }));
    link.stop();
}

TEST_CASE_METHOD(LinkRig, "a sensor whose rate was changed is configured again") {
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 20; }));
    sensor.counts_per_frame = 40;
    REQUIRE(eventually([&] { return link.status().stalls == 1; }));
    sensor.counts_per_frame = 80;
    CHECK(eventually([&] { return link.status().sessions == 2; }));
    const auto sent = sensor.frames_sent.load();
    REQUIRE(eventually([&] { return sensor.frames_sent >= sent + 60; }));
    CHECK(link.status().stalls == 1);
    link.stop();
    CHECK(Received(queue).sessions.size() == 2);
}

TEST_CASE_METHOD(FastLinkRig, "a sensor that answers but never sends a frame starts no session") {
    sensor.is_idle = true;
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return link.status().stalls == 2; }));
    CHECK(link.status().sessions == 0);
    CHECK(queue.fill() == 0);
    link.stop();
}

TEST_CASE("another device that talks is named once, however often it is asked") {
    Pty pty;
    std::atomic<bool> is_over{false};
    std::thread receiver([&] {
        const std::string line =
            "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n";
        while (!is_over) {
            pty.write(std::as_bytes(std::span(line)));
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
        }
    });
    ReadQueue queue;
    const HostClock clock(ClockScale{10.0, host_realtime(), host_realtime()});
    SensorLink link(options_for(pty.path()), clock, queue);
    link.start();
    std::vector<std::string> said;
    const bool has_failed_often = eventually([&] {
        const LinkStatus status = link.status();
        if (said.empty() || said.back() != status.trouble.english())
            said.push_back(status.trouble.english());
        return status.handshake_failures >= 8;
    });
    link.stop();
    is_over = true;
    receiver.join();
    REQUIRE(has_failed_often);
    CHECK(said.size() <= 3);  // looked for, configured, and this:
    CHECK_THAT(said.back(),
               ContainsSubstring("another device") && ContainsSubstring("sensor.port"));
}

TEST_CASE_METHOD(FastLinkRig, "a port that disappears is named and searched for until it is back") {
    const test::TemporaryDirectory directory;
    const auto name = directory.path() / "sensor";
    SensorLink link(options_for(name), clock, queue);
    link.start();
    REQUIRE(eventually([&] { return link.status().state == LinkStatus::State::searching; }));
    REQUIRE(eventually([&] {
        return link.status().trouble ==
               name.string() + ": there is no such port; check the cable, and a351d --list-ports";
    }));
    {
        FakeSensor unplugged;
        std::filesystem::create_symlink(unplugged.path(), name);
        REQUIRE(eventually([&] { return unplugged.frames_sent >= 5; }));
    }
    REQUIRE(eventually([&] { return link.status().ports_lost == 1; }));
    const std::string said =
        "sensor unplugged: the port is gone (" + name.string() + "); plug the cable in again";
    CHECK(link.status().trouble == said);
    std::filesystem::remove(name);  // The system then has another reason, which is not shown.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(link.status().trouble == said);
    const auto sessions_before = link.status().sessions;
    std::filesystem::create_symlink(sensor.path(), name);
    REQUIRE(eventually([&] { return link.status().sessions > sessions_before; }));
    link.stop();
}

TEST_CASE("another instrument is refused by its serial number and stopped") {
    FakeSensor sensor("00000099");
    ReadQueue queue;
    const HostClock clock;
    LinkOptions options = options_for(sensor.path());
    options.expected_serial_number = "00000042";
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return link.status().handshake_failures == 1; }));
    CHECK(link.status().trouble == "another instrument: serial number 00000099, expected 00000042");
    CHECK(eventually([&] { return !sensor.is_sampling(); }));
    link.stop();
    CHECK(queue.fill() == 0);
}

TEST_CASE_METHOD(LinkRig, "a port that another process has open is refused at the start") {
    const auto held = open_port({sensor.path(), {}}, 460800);
    SensorLink link(options, clock, queue);
    CHECK_THROWS_AS(link.start(), PortError);
}

TEST_CASE_METHOD(LinkRig,
                 "a stream that continues where the journal ended is adopted without a command") {
    options.expected_serial_number = "00000042";
    options.known = known_stream(options, clock, 0);
    sensor.start_sampling();
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 30; }));
    REQUIRE(eventually([&] { return link.status().adoptions == 1; }));
    CHECK(link.status().sessions == 0);
    CHECK(link.status().is_device_assumed);
    CHECK(link.status().device->serial_number == "00000042");

    const Received received(queue);
    link.stop();
    REQUIRE(received.sessions.size() == 1);
    CHECK(received.sessions[0].session == options.known->header.session);
    CHECK(received.sessions[0].is_device_assumed);
    CHECK(received.sessions[0].port == sensor.path());
    CHECK(received.sent.empty());
    REQUIRE(received.frames().size() > 10);
    CHECK(received.frames()[0] == FakeSensor::values(0));
}

TEST_CASE_METHOD(LinkRig, "a failed start-up test is reported until a later one is passed") {
    using wire::StartUpTest;
    /// Runs a link to its first session or adoption.  @return the header of the recorded session
    const auto recorded = [&](bool is_adopted = false) {
        ReadQueue reads;
        SensorLink link(options, clock, reads);
        if (options.known)
            CHECK(link.status().start_up_test == options.known->header.start_up_test);
        link.start();
        REQUIRE(eventually(
            [&] { return (is_adopted ? link.status().adoptions : link.status().sessions) == 1; }));
        link.stop();
        const Received received(reads);
        REQUIRE(received.sessions.size() == 1);
        CHECK(received.sessions[0].start_up_test == link.status().start_up_test);
        return received.sessions[0];
    };
    sensor.raise(wire::kDiagHardError);  // The test after the next reset is passed.
    const journal::Header failed = recorded();
    CHECK(failed.start_up_test == StartUpTest::hard_error);
    SECTION("an adopted stream is of the same power-on") {
        options.known = journal::StreamEnd{failed, 0, clock.raw()};
        sensor.lose_power();  // Its counter is 0, as in `known`.
        sensor.start_sampling();
        CHECK(recorded(true).start_up_test == StartUpTest::hard_error);
    }
    SECTION("a test whose result is lost on the line is repeated") {
        sensor.lose_answers(wire::kDiagStat, 1);
        sensor.fail_start_ups(wire::kDiagFlashError);
        CHECK(recorded().start_up_test == StartUpTest::flash_error);
    }
    SECTION("a sensor that is configured again repeats the test") {
        options.known = journal::StreamEnd{failed, 0, clock.raw()};
        CHECK(recorded().start_up_test == StartUpTest::passed);
    }
}

TEST_CASE_METHOD(LinkRig,
                 "a stream that may be another one is stopped, and the sensor is configured") {
    options.known = known_stream(options, clock, 0);
    SECTION("its counter is eight seconds off") { options.known->count = 80 * 400; }
    SECTION("the port was another one") { options.known->header.port = "elsewhere"; }
    SECTION("it had another filter") { options.known->header.filter = "other"; }
    SECTION("the host was rebooted") { options.known->header.boot_id = "other"; }
    SECTION("another instrument is expected") {
        options.known->header.serial_number = "00000099";
        options.expected_serial_number = "00000042";
    }
    bool is_silent = false;
    SECTION("it is silent") { is_silent = true; }
    if (!is_silent) sensor.start_sampling();
    SensorLink link(options, clock, queue);
    link.start();
    REQUIRE(eventually([&] { return link.status().sessions == 1; }));
    CHECK(link.status().adoptions == 0);
    link.stop();
    const Received received(queue);
    REQUIRE(received.sessions.size() == 1);
    CHECK_FALSE(received.sent.empty());
    CHECK_FALSE(received.sessions[0].session == options.known->header.session);
}
