#include "daemon/source/port.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <vector>
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/pty.hpp"

using namespace a351;
using namespace a351::daemon::source;
using std::chrono::milliseconds;

namespace {

constexpr milliseconds kPatience{2000};

std::vector<std::byte> every_byte() {
    std::vector<std::byte> bytes;
    for (int value = 0; value < 256; ++value) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

PortError::Kind kind_of_refusal(const PortAddress& address) {
    try {
        (void)open_port(address, 460800);
    } catch (const PortError& error) {
        return error.kind();
    }
    FAIL("the port was opened");
    return PortError::Kind::absent;
}

std::ptrdiff_t open_files() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

}  // namespace

TEST_CASE("every byte value passes a port both ways") {
    Pty pty;
    const auto port = open_port({pty.path(), {}}, 460800);
    const auto sent = every_byte();

    REQUIRE(port->write(sent));
    CHECK(pty.read(kPatience) == sent);

    pty.write(sent);
    std::vector<std::byte> received;
    std::vector<std::byte> some(100);
    while (received.size() < sent.size()) {
        const auto count = port->read(some, kPatience);
        REQUIRE(count.value_or(0) > 0);
        received.insert(received.end(), some.begin(),
                        some.begin() + static_cast<std::ptrdiff_t>(*count));
    }
    CHECK(received == sent);
}

TEST_CASE("a port left in cooked mode, with flow control and two stop bits, is set to raw 8N1") {
    Pty pty;
    const int before = open(pty.path().c_str(), O_RDWR | O_NOCTTY);
    termios settings{};
    REQUIRE(tcgetattr(before, &settings) == 0);
    settings.c_iflag |= IXON | IXOFF | IXANY | ICRNL | INLCR | IGNCR | ISTRIP;
    settings.c_lflag |= ICANON | ECHO | ISIG;
    settings.c_cflag |= CSTOPB | CRTSCTS;
    REQUIRE(tcsetattr(before, TCSANOW, &settings) == 0);

    const auto port = open_port({pty.path(), {}}, 230400);
    REQUIRE(tcgetattr(before, &settings) == 0);
    close(before);
    CHECK((settings.c_iflag & (IXON | IXOFF | IXANY | ICRNL | INLCR | IGNCR | ISTRIP)) == 0);
    CHECK((settings.c_lflag & (ICANON | ECHO | ISIG | IEXTEN)) == 0);
    CHECK((settings.c_oflag & OPOST) == 0);
    CHECK((settings.c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS)) == CS8);
    CHECK((settings.c_cflag & (CLOCAL | CREAD)) == (CLOCAL | CREAD));
    CHECK(cfgetispeed(&settings) == B230400);
    CHECK(cfgetospeed(&settings) == B230400);
    CHECK(port->description().find("230400 baud") != std::string::npos);
}

TEST_CASE("a port that is in use is refused as locked, and free again after it is closed") {
    Pty pty;
    auto port = open_port({pty.path(), {}}, 460800);
    CHECK(kind_of_refusal({pty.path(), {}}) == PortError::Kind::locked);
    port.reset();
    CHECK_NOTHROW(open_port({pty.path(), {}}, 460800));
}

TEST_CASE("silence does not end a connection, but closing the other end does") {
    Pty pty;
    const auto port = open_port({pty.path(), {}}, 460800);
    std::vector<std::byte> some(100);
    CHECK(port->read(some, milliseconds(10)) == 0U);
    pty.write(std::vector<std::byte>(3));
    CHECK(port->read(some, kPatience) == 3U);
    pty.close_master();
    CHECK(port->read(some, kPatience) == std::nullopt);
    CHECK_FALSE(port->write(some));
}

TEST_CASE(
    "a port is found through links, and a missing port and a wrong file are different errors") {
    Pty pty;
    const test::TemporaryDirectory directory;
    const auto link = directory.path() / "sensor";
    std::filesystem::create_symlink(pty.path(), directory.path() / "hop");
    std::filesystem::create_symlink("hop", link);
    CHECK(open_port({link, {}}, 460800)->description().starts_with(pty.path()));

    CHECK(kind_of_refusal({directory.path() / "none", {}}) == PortError::Kind::absent);
    CHECK(kind_of_refusal({{}, UsbAddress{0xFFFF, 0xFFFF, "no such adapter"}}) ==
          PortError::Kind::absent);
    // The recorder tries again every second, so a file that stays open would use them up.
    const std::ptrdiff_t before = open_files();
    CHECK(kind_of_refusal({"/dev/null", {}}) == PortError::Kind::settings);
    CHECK(open_files() == before);
}

TEST_CASE("the table of ports marks those that could be the sensor") {
    CHECK(port_table({{"/dev/ttyS0", {}, {}},
                      {"/dev/ttyUSB0", "/dev/serial/by-id/x", UsbAddress{0x0403, 0x6001, "A1"}}}) ==
          "PORT\tBY-ID\tUSB VID:PID:SERIAL\tREMARK\n"
          "/dev/ttyS0\t-\t-\t-\n"
          "/dev/ttyUSB0\t/dev/serial/by-id/x\t0403:6001:A1\tFTDI: could be the sensor\n");
}
