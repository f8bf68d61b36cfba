#include "sim/line/sensor_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::line;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;
using namespace a351::sim::truth;
using namespace std::chrono_literals;

namespace {

std::filesystem::path link_path(const std::string& name) {
    return std::filesystem::temp_directory_path() /
           ("a351_" + name + "_" + std::to_string(::getpid()));
}

/// The host's end of the line, opened as a program would.
class Host {
public:
    explicit Host(const std::filesystem::path& link)
        : port_(::open(link.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
        REQUIRE(port_ >= 0);
    }
    ~Host() { ::close(port_); }
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    void send(std::string_view hex) {
        const auto bytes = bytes_of(hex);
        REQUIRE(::write(port_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    }

    /// Reads until `count` bytes are there or nothing has come for two seconds.
    std::vector<std::byte> receive(std::size_t count) {
        std::vector<std::byte> bytes;
        pollfd watched{port_, POLLIN, 0};
        while (bytes.size() < count && ::poll(&watched, 1, 2000) > 0) {
            std::array<std::byte, 4096> buffer;
            const ssize_t got =
                ::read(port_, buffer.data(), std::min(buffer.size(), count - bytes.size()));
            if (got <= 0) break;
            bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
        }
        return bytes;
    }

    [[nodiscard]] bool is_readable() {
        pollfd watched{port_, POLLIN, 0};
        return ::poll(&watched, 1, 100) > 0;
    }

    void discard() { ::tcflush(port_, TCIFLUSH); }

    void set_speed(speed_t speed) {
        termios settings{};
        REQUIRE(::tcgetattr(port_, &settings) == 0);
        ::cfsetspeed(&settings, speed);
        REQUIRE(::tcsetattr(port_, TCSANOW, &settings) == 0);
    }

private:
    int port_;
};

void wait_for(const Pty& pty) {
    pollfd watched = pty.watched(false);
    REQUIRE(::poll(&watched, 1, 1000) == 1);
}

/// The emulator in a thread of its own.
struct Served {
    Served(const std::string& name, double speed)
        : link(link_path(name)), pty(link), thread([this, speed] {
              const ClockScale clock{speed, scenario.start(), host_now()};
              std::array<Service*, 1> services{&port};
              attend(services, clock, [this] {
                  const std::lock_guard lock(mutex);
                  if (fault) faults.apply(*std::exchange(fault, std::nullopt), fault_at);
                  return stop.load();
              });
          }) {}
    ~Served() { end(); }

    /// Requests a fault, which the emulator's thread applies some time later.
    void apply(std::string_view words, UtcTime at) {
        const std::lock_guard lock(mutex);
        fault = parse_fault(words, {profile, 50.0});
        fault_at = at;
    }

    void end() {
        stop = true;
        if (thread.joinable()) thread.join();
    }

    const wire::DeviceProfile& profile = *wire::find_profile("A352AD10");

    std::filesystem::path link;
    Scenario scenario = load_scenario("tsukuba");
    signal::Source source{scenario, profile, 1};
    RegisterMachine machine{
        profile, {"A352AD10", "01234567", 1}, steady_now() - power_on_time(profile)};
    std::vector<truth::Record> truth;
    DeviceStream stream{source, machine};
    Line line{{}, 1, scenario.start(), [this](const truth::Record& r) { truth.push_back(r); }};
    FaultInjector faults{{}, scenario.start(), line, machine, profile, {}, {}};
    Pty pty;
    std::vector<std::string> troubles;
    SensorPort port{pty, stream, line, &faults,
                    [this](const std::string& trouble) { troubles.push_back(trouble); }};
    std::mutex mutex;
    std::optional<Fault> fault;
    UtcTime fault_at;
    std::atomic<bool> stop = false;
    std::thread thread;
};

constexpr std::string_view kStartLogging =
    "FE 01 0D 85 06 0D 86 06 0D 88 01 0D 8C 03 0D 8D C7 0D FE 00 0D 83 01 0D";

}  // namespace

TEST_CASE("nothing is unread only when the host has read all, also right after a write") {
    Pty pty(link_path("unread"));
    const int host = ::open(pty.slave_path().c_str(), O_RDONLY | O_NOCTTY | O_CLOEXEC);
    REQUIRE(host >= 0);
    const std::array<std::byte, 24> frame{};
    std::array<std::byte, 24> read{};
    int missed = 0, left = 0;
    for (int i = 0; i < 20'000; ++i) {
        REQUIRE(pty.write(frame) == frame.size());
        missed += pty.unread() != frame.size();
        REQUIRE(::read(host, read.data(), read.size()) == static_cast<ssize_t>(read.size()));
        left += pty.unread() != 0;
    }
    ::close(host);
    CHECK(missed == 0);
    CHECK(left == 0);
}

TEST_CASE("a host configures the device, does not read for a while, and loses no frame") {
    Served served("stall", 1000.0);
    Host host(served.link);
    host.send("FE 01 0D 6A 00 0D");
    CHECK(hex_of(host.receive(4)) == "6A 33 41 0D");
    host.send(kStartLogging);
    // Half a second is 25 000 frames, 600 kB: far more than the terminal holds.
    std::this_thread::sleep_for(500ms);
    constexpr std::size_t kFrames = 30'000;
    const auto bytes = host.receive(kFrames * 24);
    served.end();
    REQUIRE(bytes.size() == kFrames * 24);
    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input(bytes);
    std::size_t frames = 0;
    while (const auto event = decoder.next(input)) {
        REQUIRE(std::holds_alternative<wire::BurstFrame>(*event));
        const wire::BurstValues& values = std::get<wire::BurstFrame>(*event).values();
        REQUIRE(values == served.truth.at(frames).values);
        REQUIRE(values.count == static_cast<std::uint16_t>(80 * (frames + 1)));
        ++frames;
    }
    CHECK(frames == kFrames);
    CHECK(served.line.report().largest_lateness > 100s);
}

TEST_CASE("the terminal is raw: every byte value passes both ways, at each visit of a host") {
    const auto link = link_path("raw");
    Pty pty(link);
    for (int visit = 0; visit < 2; ++visit) {
        Host brief(link);
        brief.send("0D");
        wait_for(pty);
        CHECK(pty.read().size() == 1);
    }
    CHECK(pty.read().empty());
    Host host(link);
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    REQUIRE(pty.write(all) == all.size());
    CHECK(host.receive(all.size()) == all);
    host.send(hex_of(all));
    std::vector<std::byte> got;
    while (got.size() < all.size()) {
        wait_for(pty);
        const auto more = pty.read();
        REQUIRE_FALSE(more.empty());
        got.insert(got.end(), more.begin(), more.end());
    }
    CHECK(got == all);
}

TEST_CASE("the link replaces a stale one and is removed with the device, unless it is another's") {
    const auto link = link_path("link");
    std::filesystem::create_symlink("/dev/pts/987654", link);
    {
        const Pty pty(link);
        CHECK(std::filesystem::read_symlink(link) == pty.slave_path());
    }
    CHECK_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
    {
        const Pty pty(link);
        std::filesystem::remove(link);
        std::filesystem::create_symlink("/nonexistent", link);
    }
    CHECK(std::filesystem::read_symlink(link) == "/nonexistent");
    std::filesystem::remove(link);
}

TEST_CASE("a path that belongs to somebody else is refused and left in place") {
    const auto link = link_path("foreign");
    const auto refused = [&link] {
        CHECK_THROWS_AS(Pty(link), InputError);
        CHECK(std::filesystem::exists(std::filesystem::symlink_status(link)));
        std::filesystem::remove(link);
    };
    std::ofstream(link) << "a file of somebody";
    refused();
    std::filesystem::create_symlink("/nonexistent", link);
    refused();
    const Pty other(link_path("other"));
    std::filesystem::create_symlink(other.slave_path(), link);  // A terminal that is served.
    refused();
    CHECK_THROWS_AS(Pty("/nonexistent/sensor"), InputError);
    CHECK_THROWS_AS(Pty(""), InputError);
    CHECK_THROWS_AS(Pty(link_path(std::string(300, 'x'))), InputError);
    CHECK_THROWS_AS(Pty("/proc/a351"), InputError);
    std::filesystem::create_symlink(link, link);
    CHECK_THROWS_AS(Pty(link / "sensor"), InputError);
    refused();
}

TEST_CASE("a terminal that hangs up comes back under another name") {
    const auto link = link_path("hang_up");
    Pty pty(link, 115200);
    CHECK(pty.baud() == 115200);
    const std::string before = pty.slave_path();
    Host host(link);
    pty.hang_up();
    CHECK_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
    CHECK(host.receive(1).empty());
    pty.come_back();
    CHECK(pty.slave_path() != before);
    Host again(link);
    again.send("0D");
    wait_for(pty);
    CHECK(pty.read().size() == 1);
    CHECK(pty.baud() == 115200);
}

TEST_CASE("nothing is understood at a wrong speed, and everything at the right one") {
    Served served("speed", 1.0);
    Host host(served.link);
    host.set_speed(B115200);
    host.send("FE 01 0D 6A 00 0D");
    CHECK(hex_of(host.receive(4)) != "6A 33 41 0D");
    host.set_speed(B460800);
    std::this_thread::sleep_for(200ms);  // A half-understood command is forgotten.
    host.discard();
    host.send("FE 01 0D 6A 00 0D");
    CHECK(hex_of(host.receive(4)) == "6A 33 41 0D");
}

TEST_CASE("a device that waits for the baud rate sends nothing at another one") {
    struct Waiting final : LineDevice {
        void receive(std::span<const std::byte>, const Instant&, LineSink&) override {}
        void advance_to(const Instant& now, LineSink& line) override {
            line.send(std::array{std::byte{0x80}}, now.simulated, nullptr);
        }
        [[nodiscard]] std::optional<UtcTime> next_due() const override { return UtcTime(); }
        [[nodiscard]] int baud() const override { return 460800; }
        [[nodiscard]] bool waits_for_baud() const override { return true; }
    } device;
    Pty pty(link_path("waiting"));
    Line line({}, 0, UtcTime(), [](const truth::Record&) {});
    SensorPort port(pty, device, line);
    Host host(link_path("waiting"));
    const Instant now{UtcTime(1s), 1s};
    host.set_speed(B115200);
    port.serve(now);
    CHECK_FALSE(host.is_readable());
    CHECK(port.patience(now, {}) > 0ns);
    host.set_speed(B460800);
    port.serve(now);
    CHECK(hex_of(host.receive(1)) == "80");
}

TEST_CASE("an overrun loses the frames that do not fit and reports their exact number") {
    Served served("overrun", 50.0);
    served.apply("overrun", served.scenario.start());
    Host host(served.link);
    host.send(kStartLogging);
    std::this_thread::sleep_for(400ms);  // 1000 frames, 24 kB.
    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::int64_t frames = 0;
    const auto read = [&](std::size_t count) {
        const auto bytes = host.receive(count);
        std::span<const std::byte> input(bytes);
        while (const auto event = decoder.next(input)) {
            frames += std::holds_alternative<wire::BurstFrame>(*event) ? 1 : 0;
        }
    };
    read(24 * 500);
    host.send("FE 00 0D 83 02 0D");
    std::this_thread::sleep_for(300ms);
    served.end();
    while (host.is_readable()) read(1);
    const line::Report& report = served.line.report();
    // 4095 bytes are 170 frames; the kernel's own buffer lets some more pass.
    CHECK(report.lost_by_overrun > 700);
    CHECK(report.frames_lost == report.lost_by_overrun);
    CHECK(report.frames_sent == frames);
    CHECK(report.frames_made == report.frames_sent + report.frames_lost + report.frames_damaged);
    CHECK(served.truth.size() == static_cast<std::size_t>(report.frames_made));
}

TEST_CASE("at the end every frame and every unread byte is accounted for") {
    Served served("settled", 1000.0);
    Host host(served.link);
    host.send(kStartLogging);
    const bool is_reading = GENERATE(true, false);
    if (is_reading) {
        REQUIRE(host.receive(24 * 100).size() == 24 * 100);
        host.send("83 02 0D");
        while (host.is_readable()) static_cast<void>(host.receive(4096));
    } else {
        std::this_thread::sleep_for(500ms);  // 25 000 frames.
    }
    served.end();
    served.port.finish(served.scenario.start() + 24h);
    const line::Report& report = served.line.report();
    CHECK(report.frames_made ==
          report.frames_sent + report.frames_damaged + report.frames_lost + report.frames_pending);
    CHECK(served.truth.size() == static_cast<std::size_t>(report.frames_made));
    CHECK(served.port.was_drained() == is_reading);
    CHECK((report.frames_pending > 0) != is_reading);
    CHECK(served.port.bytes_unread() ==
          (is_reading ? 0 : static_cast<std::size_t>(report.bytes_handed_over)));
}

TEST_CASE("if a file has taken the link's place the port stays unplugged, reports it and waits") {
    Served served("taken", 50.0);
    const auto gone = [&served](bool is_gone) {
        for (int i = 0; i < 400; ++i) {
            if (std::filesystem::is_symlink(served.link) != is_gone) return;
            std::this_thread::sleep_for(5ms);
        }
        FAIL("the link stays");
    };
    served.apply("hang_up seconds=30", served.scenario.start() + 1s);
    gone(true);
    std::ofstream(served.link) << "a file of somebody";
    std::this_thread::sleep_for(1s);
    CHECK(std::filesystem::is_regular_file(served.link));
    std::filesystem::remove(served.link);
    gone(false);
    served.end();
    CHECK(served.line.report().frames_sent == 0);
    REQUIRE(served.troubles.size() == 1);
    CHECK(served.troubles[0].find("no link") != std::string::npos);
}
