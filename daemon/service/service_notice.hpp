#pragma once
/// @file
/// Notices to the service manager: ready, alive, status text, stopping.  Each notice is one
/// datagram of lines NAME=VALUE to the socket in NOTIFY_SOCKET: sd_notify(3), systemd 252.

#include <string>
#include <string_view>

namespace a351::daemon::service {

class ServiceNotice {
public:
    /// @param socket  path of a datagram socket, "@" and an abstract name, or empty: send nothing.
    explicit ServiceNotice(std::string socket) : socket_(std::move(socket)) {}

    /// Reads NOTIFY_SOCKET.  Must be called before threads are started.
    [[nodiscard]] static ServiceNotice from_environment();

    void ready() { send("READY=1"); }
    void stopping() { send("STOPPING=1"); }

    /// Sends the watchdog signal and the status text.  Must be called more often than the manager's
    /// watchdog time.
    /// @param is_alive  false: send no watchdog signal, so that the manager restarts the service.
    /// @param text  shown by `systemctl status`; sent when it changes; its lines are joined.
    void beat(bool is_alive, std::string_view text);

private:
    /// Sends without waiting, so that a manager that does not listen cannot delay the acquisition.
    /// @return false if it could not be sent.
    bool send(std::string_view lines) const;

    std::string socket_;
    std::string text_;  ///< Status text sent last.
};

}  // namespace a351::daemon::service
