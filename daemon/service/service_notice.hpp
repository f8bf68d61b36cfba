#pragma once
/// @file
/// What the service manager is told: ready, alive, how it is, stopping.  The protocol is one
/// datagram of lines NAME=VALUE to the socket that NOTIFY_SOCKET names: sd_notify(3), systemd 252.

#include <string>
#include <string_view>

namespace a351::daemon {

class ServiceNotice {
public:
    /// @param socket  path of a datagram socket; "@" first: an abstract name; empty: nobody listens.
    explicit ServiceNotice(std::string socket) : socket_(std::move(socket)) {}

    /// By NOTIFY_SOCKET; to be called before there are threads.
    [[nodiscard]] static ServiceNotice from_environment();

    void ready() { send("READY=1"); }
    void stopping() { send("STOPPING=1"); }

    /// To be called more often than the manager's watchdog bites.
    /// @param is_alive  false: the watchdog is left to bite.
    /// @param text  shown by `systemctl status`, told when it changes; its lines are joined.
    void beat(bool is_alive, std::string_view text);

private:
    /// Never waits: a manager that does not listen must not hold up the acquisition.
    /// @return false when nobody took it.
    bool send(std::string_view lines) const;

    std::string socket_;
    std::string text_;  ///< Last told.
};

}  // namespace a351::daemon
