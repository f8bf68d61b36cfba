#pragma once
/// @file
/// The web server of the daemon, on a thread of its own.
///
///     Server server({.listen = page.listen, .hosts = page.hosts, .token = page.token},
///                   {.status = [&] { return ...; }, .occupations = occupations, .live = live,
///                    .events = [&] { return events::read_events(root / "events").events; }});
///     for (const auto& address : server.addresses()) log->info("page at http://{}", address);
///     server.start();
///     ...
///     server.stop();
///
/// Functions and `occupations` are used on the server's thread only, from start() to stop().

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/listen_address.hpp"
#include "daemon/page/api.hpp"

namespace a351::daemon::page {

struct ServerOptions {
    config::ListenAddress listen = {};
    std::vector<std::string> hosts = {};  ///< Further accepted names (name or name:port).
    std::string token = {};               ///< Token; empty: a random one per start.
    std::vector<std::string> boxes = {};  ///< Origins of other daemons' pages, see Guard.
    std::chrono::milliseconds request_limit{10'000};  ///< Real time to complete a request.
    /// Real time after which a live viewer that accepts or answers nothing is disconnected.
    std::chrono::milliseconds stream_patience{10'000};
};

class Server {
public:
    /// Binds and listens, so that a port in use is reported at once.  With 127.0.0.1 it also
    /// listens on ::1, and the other way round, if the host supports it.
    /// @throws std::system_error  the address cannot be bound.
    Server(const ServerOptions& options, ApiSources sources);
    ~Server();

    void start();
    /// Runs a task between two requests on the server's thread, which owns the occupations.
    void post(std::function<void()> task);

    void stop() noexcept;  ///< Ends after the request at hand; open connections are closed.

    [[nodiscard]] std::uint16_t port() const noexcept;
    [[nodiscard]] const std::vector<std::string>& addresses() const noexcept;

    /// Returns true if other hosts can connect; the daemon then logs a warning.
    [[nodiscard]] bool is_exposed() const noexcept;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace a351::daemon::page
