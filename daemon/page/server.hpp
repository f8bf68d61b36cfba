#pragma once
/// @file
/// The web server of the daemon, on a thread of its own.
///
///     Server server({.listen = page.listen, .hosts = page.hosts, .token = page.token},
///                   {.status = [&] { return ...; }, .occupations = occupations, .live = live,
///                    .events = [&] { return record::read_events(root / "events").events; }});
///     for (const auto& address : server.addresses()) log->info("page at http://{}", address);
///     server.start();
///     ...
///     server.stop();
///
/// The functions and `occupations` are used on the server's thread only, from start() to stop().

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/listen_address.hpp"
#include "daemon/page/api.hpp"

namespace a351::daemon {

struct ServerOptions {
    ListenAddress listen = {};
    std::vector<std::string> hosts = {};  ///< Further names (name or name:port) it answers to.
    std::string token = {};               ///< Empty: a random one per start.

    std::size_t connection_limit = 32;
    std::chrono::milliseconds request_limit{10'000};  ///< Real time to complete a request.
    std::size_t stream_limit = 20;                    ///< Live ones, of the connections.
    /// Real time after which a live viewer that takes or answers nothing is left.
    std::chrono::milliseconds stream_patience{10'000};
};

class Server {
public:
    /// Binds and listens, so that a port in use is known at once.  A loopback address of one
    /// family also brings that of the other, where the host has it.
    /// @throws std::system_error  the address cannot be bound.
    Server(const ServerOptions& options, ApiSources sources);
    ~Server();

    void start();
    /// Has the server's thread do it, between two requests: that owns the occupations.
    void post(std::function<void()> task);

    void stop() noexcept;  ///< Ends after the request at hand; open connections are closed.

    [[nodiscard]] std::uint16_t port() const noexcept;
    [[nodiscard]] const std::vector<std::string>& addresses() const noexcept;

    /// True when others than this host can connect: worth a loud line in the log.
    [[nodiscard]] bool is_exposed() const noexcept;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace a351::daemon
