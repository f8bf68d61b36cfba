#include "sim/line/control_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::sim::line;
namespace fs = std::filesystem;

namespace {

fs::path socket_path(const std::string& name) {
    return fs::temp_directory_path() / ("a351_" + name + "_" + std::to_string(::getpid()));
}

std::string echo(const std::string& line) {
    if (line == "bad") throw InputError("no such thing; allowed: another");
    if (line == "worse") throw std::runtime_error("no terminal left");
    if (line == "long") return std::string(100'000, 'x');
    return line;
}

/// Calls ::connect or ::bind with the path of a socket.
template <typename Function>
int at_path(Function function, int socket, const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.native().size() + 1);
    return function(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

class Client {
public:
    explicit Client(const fs::path& path)
        : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
        REQUIRE(at_path(::connect, socket_, path) == 0);
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void say(std::string_view text) {
        REQUIRE(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) ==
                static_cast<ssize_t>(text.size()));
    }
    std::string hear() {
        std::string text;
        std::array<char, 65536> buffer;
        for (ssize_t got; (got = ::recv(socket_, buffer.data(), buffer.size(), 0)) > 0;) {
            text.append(buffer.data(), static_cast<std::size_t>(got));
        }
        return text;
    }
    bool is_dropped() {
        char byte;
        return ::recv(socket_, &byte, 1, 0) == 0;
    }

private:
    int socket_;
};

}  // namespace

TEST_CASE("each line is answered with ok or error, however it is split") {
    const auto path = socket_path("lines");
    ControlSocket socket(path, echo);
    Client client(path);
    const std::string text = "one\nbad\n\nworse\ntwo\n";
    for (std::size_t cut = 0; cut <= text.size(); ++cut) {
        client.say(text.substr(0, cut));
        socket.serve({});
        client.say(text.substr(cut));
        socket.serve({});
        CHECK(client.hear() ==
              "ok one\nerror no such thing; allowed: another\nok\n"
              "error no terminal left\nok two\n");
    }
    client.say("long\nlong\nlong\n");  // Too long to be sent at once.
    std::string heard;
    for (int i = 0; i < 100; ++i) {
        socket.serve({});
        heard += client.hear();
    }
    CHECK(heard.size() == 3 * 100'004);
}

TEST_CASE("a bad client is dropped and the others are served") {
    const auto path = socket_path("bad");
    ControlSocket socket(path, echo);
    Client good(path);
    Client endless(path);
    auto gone = std::make_unique<Client>(path);
    gone->say("one\n");
    gone.reset();
    const std::string chunk(4000, 'x');
    endless.say(chunk);
    socket.serve({});
    endless.say(chunk);
    socket.serve({});
    CHECK(endless.hear().starts_with("error line too long"));
    CHECK(endless.is_dropped());
    good.say("still there\n");
    socket.serve({});
    CHECK(good.hear() == "ok still there\n");
}

TEST_CASE("a client that does not read is dropped before it costs much memory") {
    const auto path = socket_path("deaf");
    ControlSocket socket(path, echo);
    Client deaf(path);
    bool was_dropped = false;
    for (int i = 0; i < 40 && !was_dropped; ++i) {
        deaf.say("long\n");
        socket.serve({});
        std::vector<pollfd> watched;
        socket.watch(watched);
        was_dropped = watched.size() == 1;
    }
    CHECK(was_dropped);
}

TEST_CASE("clients beyond the largest number are turned away") {
    const auto path = socket_path("many");
    ControlSocket socket(path, echo);
    std::vector<std::unique_ptr<Client>> clients;
    for (std::size_t i = 0; i < ControlSocket::kMostClients; ++i) {
        clients.push_back(std::make_unique<Client>(path));
        socket.serve({});
    }
    Client late(path);
    socket.serve({});
    CHECK(late.is_dropped());
    clients.front()->say("one\n");
    socket.serve({});
    CHECK(clients.front()->hear() == "ok one\n");
}

TEST_CASE("the socket's path is removed at the end, and only if it is ours") {
    const auto path = socket_path("path");
    { const ControlSocket socket(path, echo); }
    CHECK_FALSE(fs::exists(path));
    {
        const ControlSocket socket(path, echo);
        fs::remove(path);
        std::ofstream(path) << "somebody else's";
    }
    CHECK(fs::exists(path));
    CHECK_THROWS_AS(ControlSocket(path, echo), InputError);
    CHECK(fs::exists(path));
    fs::remove(path);
}

TEST_CASE("a stale socket is replaced, but one with a listener is not") {
    const auto path = socket_path("stale");
    const int stale = ::socket(AF_UNIX, SOCK_STREAM, 0);
    REQUIRE(at_path(::bind, stale, path) == 0);
    ::close(stale);
    const ControlSocket socket(path, echo);
    CHECK_THROWS_AS(ControlSocket(path, echo), InputError);
    CHECK(fs::is_socket(path));
    CHECK_THROWS_AS(ControlSocket("/nonexistent/socket", echo), InputError);
    CHECK_THROWS_AS(ControlSocket(fs::temp_directory_path() / std::string(200, 'x'), echo),
                    InputError);
    CHECK_THROWS_AS(ControlSocket("", echo), InputError);
    CHECK_THROWS_AS(ControlSocket("/proc/a351", echo), InputError);
}
