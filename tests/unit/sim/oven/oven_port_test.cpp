#include "sim/oven/oven_port.hpp"

#include <modbus/modbus.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <thread>
#include "tests/support/catch.hpp"

#include "fake_oven.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::oven;
using namespace std::chrono_literals;

namespace {

constexpr Nanoseconds kNoAnswer = 300ms;  ///< Time to wait if no answer is expected.

/// The port of a fake oven, served by a thread of its own.
class RunningOven {
public:
    FakeOven oven;
    std::filesystem::path link;

    RunningOven()
        : link(std::filesystem::temp_directory_path() /
               ("a351-oven-" + std::to_string(::getpid()))),
          port_(link, oven) {}
    ~RunningOven() { stop(); }

    void start() {
        thread_ = std::thread([this] {
            std::array<Service*, 1> services{&port_};
            attend(services, ClockScale{1.0, host_now(), host_now()},
                   [this] { return stop_.load(); });
        });
    }

    /// Stops the thread.  Everything that it has written can then be read.
    void stop() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        stop_ = false;
    }

    /// Returns the port, for use while the thread is stopped.
    oven::Port& port() { return port_; }

private:
    oven::Port port_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

/// libmodbus as the master: an implementation independent of ours.
class Master {
public:
    explicit Master(const std::filesystem::path& link, int baud = 9600)
        : context_(modbus_new_rtu(link.c_str(), baud, 'N', 8, 1), modbus_free) {
        REQUIRE(context_);
        REQUIRE(modbus_set_slave(context_.get(), 1) == 0);
        wait_at_most(5s);  // An answer takes 50 to 300 ms, longer on a busy machine.
        REQUIRE(modbus_connect(context_.get()) == 0);
    }
    ~Master() { modbus_close(context_.get()); }

    modbus_t* get() { return context_.get(); }

    void wait_at_most(Nanoseconds limit) {
        const auto us = static_cast<std::uint32_t>(limit / 1us);
        REQUIRE(modbus_set_response_timeout(get(), us / 1'000'000, us % 1'000'000) == 0);
    }

    /// Waits for an answer that comes too late, and discards it.
    void await_late_answer() {
        pollfd watched{modbus_get_socket(get()), POLLIN, 0};
        REQUIRE(::poll(&watched, 1, 10'000) == 1);
        modbus_flush(get());
    }

    /// Reads one register.  @return -1 without a valid answer; errno has the reason
    int read(int address) {
        std::uint16_t word = 0;
        return modbus_read_registers(get(), address, 1, &word) == 1 ? word : -1;
    }

private:
    std::unique_ptr<modbus_t, decltype(&modbus_free)> context_;
};

}  // namespace

TEST_CASE("libmodbus reads and writes the oven") {
    RunningOven running;
    running.start();
    Master master(running.link);
    modbus_t* context = master.get();

    std::array<std::uint16_t, 5> words{};
    REQUIRE(modbus_read_registers(context, 0x2000, 5, words.data()) == 5);
    CHECK(words == std::array<std::uint16_t, 5>{425, 0x0100, 425, 0, 250});
    CHECK(master.read(0x2410) == 1);
    std::array<std::uint16_t, 106> many{};
    CHECK(modbus_read_registers(context, 0x2000, 106, many.data()) == 106);

    CHECK(modbus_write_register(context, 0x2103, 430) == -1);
    CHECK(errno == EMBXSFAIL);  // 04: communication writing is off.
    REQUIRE(modbus_write_register(context, 0x0000, 0x0001) == 1);
    REQUIRE(modbus_write_register(context, 0x2103, 430) == 1);
    CHECK(master.read(0x2103) == 430);
    const std::array<std::uint16_t, 2> four_bytes{0, 425};
    REQUIRE(modbus_write_registers(context, 0x0106, 2, four_bytes.data()) == 2);
    CHECK(master.read(0x2103) == 425);
    REQUIRE(modbus_write_register(context, 0x0000, 0x0101) == 1);
    REQUIRE(modbus_read_registers(context, 0x0002, 2, words.data()) == 2);
    CHECK(words[0] == 0x0300);  // Stopped, communication writing on.

    CHECK(modbus_write_register(context, 0x2103, 6000) == -1);
    CHECK(errno == EMBXILVAL);
    CHECK(master.read(0x2006) == -1);
    CHECK(errno == EMBXILADD);
    CHECK(modbus_read_input_registers(context, 0x2000, 1, words.data()) == -1);
    CHECK(errno == EMBXILFUN);
    std::uint8_t coil = 0;
    CHECK(modbus_read_bits(context, 0x2000, 1, &coil) == -1);
    CHECK(errno == EMBXILFUN);
    running.stop();
    CHECK(running.oven.target == DegC(42.5));
    CHECK_FALSE(running.oven.runs);
    CHECK(running.port().report().unreadable == 0);
}

TEST_CASE("libmodbus reports each fault correctly, and the next answer is good") {
    struct Case {
        std::string_view kind;
        int error;
        Nanoseconds patience = 5s;
    };
    for (const Case& c :
         {Case{"oven_exception", EMBXSFAIL}, Case{"oven_crc_error", EMBBADCRC},
          Case{"oven_wrong_unit", EMBBADSLAVE}, Case{"oven_truncated", ETIMEDOUT},
          Case{"oven_silence", ETIMEDOUT, kNoAnswer}, Case{"oven_delay", ETIMEDOUT, kNoAnswer}}) {
        CAPTURE(c.kind);
        RunningOven running;
        REQUIRE(running.port().apply_fault(c.kind, 1));
        running.start();
        Master master(running.link);
        master.wait_at_most(c.patience);
        CHECK(master.read(0x2000) == -1);
        CHECK(errno == c.error);
        if (c.kind == "oven_delay") master.await_late_answer();
        master.wait_at_most(5s);
        CHECK(master.read(0x2000) == 425);
    }
}

TEST_CASE("the oven sensor is broken and repaired by the name of the fault") {
    RunningOven running;
    CHECK_FALSE(running.port().apply_fault("oven_fire", 1));
    for (const std::string_view kind : oven::Port::fault_kinds()) {
        CAPTURE(kind);
        CHECK((kind == "oven_power_cycle" || running.port().apply_fault(kind, 0)));
    }
    REQUIRE(running.port().apply_fault("oven_sensor_break", 1));
    running.start();
    Master master(running.link);
    CHECK(master.read(0x2000) == 5000);
    CHECK(master.read(0x2001) == 0x1040);  // Input error and, at the end of the range, alarm 1.
    running.stop();
    REQUIRE(running.port().apply_fault("oven_sensor_break", 0));
    running.start();
    CHECK(master.read(0x2001) == 0x0100);
}

TEST_CASE("a master at another speed is not understood") {
    RunningOven running;
    running.start();
    Master master(running.link, 19200);
    master.wait_at_most(1s);
    CHECK(master.read(0x2000) == -1);
    CHECK(errno == ETIMEDOUT);
    running.stop();
    CHECK(running.port().report().unreadable == 1);
    CHECK(running.port().report().answers == 0);
}

TEST_CASE("an answer is lost if the oven is unplugged, and the next comes after plug and restart") {
    RunningOven running;
    const device::Instant start{host_now(), 1h};
    const auto serve = [&](Nanoseconds after) {
        running.port().serve({start.simulated, start.steady + after});
    };
    const auto ask = [](Master& master) {
        const std::array<std::uint8_t, 6> request{1, 3, 0x20, 0, 0, 1};
        REQUIRE(modbus_send_raw_request(master.get(), request.data(), request.size()) > 0);
    };
    {
        Master master(running.link);
        ask(master);
        serve(0s);
        REQUIRE(running.port().apply_fault("oven_unplug", 1));
        CHECK_FALSE(std::filesystem::is_symlink(running.link));
        serve(1s);
    }
    CHECK(running.port().report().answers == 0);
    CHECK(running.port().report().answers_lost == 1);
    REQUIRE(running.port().apply_fault("oven_unplug", 0));
    REQUIRE(running.port().apply_fault("oven_power_cycle", 1));
    Master master(running.link);
    serve(2s);
    ask(master);
    serve(3s);
    serve(4s);
    CHECK(running.port().report().ignored == 1);
    ask(master);
    serve(8s);
    serve(9s);
    CHECK(running.port().report().answers == 1);
}
