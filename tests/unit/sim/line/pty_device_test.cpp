#include "sim/line/pty_device.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <thread>

#include "protocol/wire/burst_decoder.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
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

private:
    int port_;
};

/// The emulator in a thread of its own.
struct Served {
    Served(const std::string& name, double speed)
        : link(link_path(name)), pty(link), thread([this, speed] {
              const ClockScale clock{speed, scenario.start(), host_now()};
              run = serve(pty, stream, clock, [this] { return stop.load(); });
          }) {}
    ~Served() {
        stop = true;
        if (thread.joinable()) thread.join();
    }

    std::filesystem::path link;
    Scenario scenario = load_scenario("tsukuba");
    SignalSource source{scenario, *wire::find_profile("A352AD10"), 1};
    RegisterMachine machine{*wire::find_profile("A352AD10"),
                            {"A352AD10", "01234567", 1},
                            steady_now() - RegisterMachine::kPowerOnTime};
    std::vector<TruthRecord> truth;
    DeviceStream stream{source, machine, [this](const TruthRecord& r) { truth.push_back(r); }};
    Pty pty;
    PtyRun run;
    std::atomic<bool> stop = false;
    std::thread thread;
};

constexpr std::string_view kStartLogging =
    "FE 01 0D 85 06 0D 86 06 0D 88 01 0D 8C 03 0D 8D C7 0D FE 00 0D 83 01 0D";

}  // namespace

TEST_CASE("a host configures the device through the terminal and reads its frames",
          "[sim][pty_device]") {
    Served served("round_trip", 200.0);
    Host host(served.link);
    host.send("FE 01 0D 6A 00 0D");
    CHECK(hex_of(host.receive(4)) == "6A 33 41 0D");
    host.send(kStartLogging);

    constexpr std::size_t kFrames = 2000;
    const auto bytes = host.receive(kFrames * 24);
    REQUIRE(bytes.size() == kFrames * 24);
    served.stop = true;
    served.thread.join();

    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input(bytes);
    std::size_t index = 0;
    while (const auto event = decoder.next(input)) {
        REQUIRE(std::holds_alternative<wire::BurstFrame>(*event));
        REQUIRE(index < served.truth.size());
        REQUIRE(std::get<wire::BurstFrame>(*event).values() == served.truth[index].values);
        ++index;
    }
    CHECK(index == kFrames);
}

TEST_CASE("a host that does not read for a while loses nothing", "[sim][pty_device]") {
    Served served("stall", 1000.0);
    Host host(served.link);
    host.send(kStartLogging);
    // Half a second is 25 000 frames, 600 kB: far more than the terminal holds.
    std::this_thread::sleep_for(500ms);
    constexpr std::size_t kFrames = 30'000;
    const auto bytes = host.receive(kFrames * 24);
    served.stop = true;
    served.thread.join();
    REQUIRE(bytes.size() == kFrames * 24);
    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input(bytes);
    std::uint16_t expected = 80;
    std::size_t frames = 0;
    while (const auto event = decoder.next(input)) {
        REQUIRE(std::holds_alternative<wire::BurstFrame>(*event));
        REQUIRE(std::get<wire::BurstFrame>(*event).values().count == expected);
        expected = static_cast<std::uint16_t>(expected + 80);
        ++frames;
    }
    CHECK(frames == kFrames);
    CHECK(served.stream.report().largest_lateness > 100s);
}

TEST_CASE("the terminal is raw: every byte value passes both ways", "[sim][pty]") {
    const auto link = link_path("raw");
    Pty pty(link);
    Host host(link);
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    REQUIRE(pty.write(all) == all.size());
    CHECK(host.receive(all.size()) == all);
    host.send(hex_of(all));
    std::vector<std::byte> got;
    while (got.size() < all.size()) {
        pty.wait(false, 1s);
        const auto more = pty.read();
        REQUIRE_FALSE(more.empty());
        got.insert(got.end(), more.begin(), more.end());
    }
    CHECK(got == all);
}

TEST_CASE("a host may come and go", "[sim][pty]") {
    const auto link = link_path("come_and_go");
    Pty pty(link);
    for (int visit = 0; visit < 3; ++visit) {
        Host host(link);
        host.send("0D");
        pty.wait(false, 1s);
        CHECK(pty.read().size() == 1);
    }
    CHECK(pty.read().empty());
}

TEST_CASE("the link replaces an old one, spares a file, and goes with the device", "[sim][pty]") {
    const auto link = link_path("link");
    std::filesystem::create_symlink("/nonexistent", link);
    {
        const Pty pty(link);
        CHECK(std::filesystem::read_symlink(link) == pty.slave_path());
    }
    CHECK_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
    std::ofstream(link) << "a file of somebody";
    CHECK_THROWS_AS(Pty(link), std::system_error);
    CHECK(std::filesystem::exists(link));
    std::filesystem::remove(link);
}
