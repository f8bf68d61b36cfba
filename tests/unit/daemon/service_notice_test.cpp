#include "daemon/service/service_notice.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon::service;

namespace {

/// A service manager: a bound datagram socket.
class Manager {
public:
    /// @param name  address in the form of NOTIFY_SOCKET
    explicit Manager(const std::string& name) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        REQUIRE(name.size() < sizeof address.sun_path);
        std::memcpy(address.sun_path, name.data(), name.size());
        if (name.front() == '@') address.sun_path[0] = '\0';
        REQUIRE(bind(descriptor_, reinterpret_cast<const sockaddr*>(&address),
                     static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size())) == 0);
    }
    ~Manager() { close(descriptor_); }
    Manager(const Manager&) = delete;
    Manager& operator=(const Manager&) = delete;

    std::optional<std::string> heard() {
        char datagram[4096];
        const auto size = recv(descriptor_, datagram, sizeof datagram, MSG_DONTWAIT);
        if (size < 0) return std::nullopt;
        return std::string(datagram, static_cast<std::size_t>(size));
    }

private:
    int descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

}  // namespace

TEST_CASE("the service manager is notified of start, life signs, changed status and stop") {
    const test::TemporaryDirectory directory;
    const bool is_abstract = GENERATE(false, true);
    const std::string name = is_abstract ? "@a351-test-" + std::to_string(getpid())
                                         : directory.path().string() + "/notify";
    Manager manager(name);
    ServiceNotice notice(name);
    notice.ready();
    CHECK(manager.heard() == "READY=1");
    notice.beat(true, "sampling");
    CHECK(manager.heard() == "WATCHDOG=1");
    CHECK(manager.heard() == "STATUS=sampling");
    notice.beat(true, "sampling");
    CHECK(manager.heard() == "WATCHDOG=1");
    CHECK(manager.heard() == std::nullopt);
    notice.beat(false, "two\nlines");
    CHECK(manager.heard() == "STATUS=two lines");
    notice.stopping();
    CHECK(manager.heard() == "STOPPING=1");
    CHECK(manager.heard() == std::nullopt);
}

TEST_CASE("a service manager that is absent or does not read delays nothing") {
    ServiceNotice("").ready();
    const test::TemporaryDirectory directory;
    const std::string name = directory.path().string() + "/notify";
    ServiceNotice notice(name);
    notice.ready();
    Manager manager(name);
    for (int i = 0; i < 5000; ++i) notice.beat(true, "full");  // More than a socket holds.
    int heard = 0;
    while (manager.heard()) ++heard;
    CHECK(heard < 5000);
    notice.beat(true, "sent when there is room");
    CHECK(manager.heard() == "WATCHDOG=1");
    CHECK(manager.heard() == "STATUS=sent when there is room");
}
