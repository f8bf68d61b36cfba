#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/line/fault.hpp"
#include "sim/line/service.hpp"

namespace a351::sim::line {

/// A Unix stream socket that takes orders: one line in, one line out, `ok ...` or `error ...`.
/// A client that misbehaves (endless line, answers not read, too many clients) is disconnected; the
/// other clients are not affected.
///
/// The socket's file is removed at the end, if it is still the one made here.  An existing socket
/// that refuses connections is replaced.  A socket that another program has bound but does not
/// listen on yet refuses them too, and is replaced.  Anything else at the path is kept.
class ControlSocket final : public Service {
public:
    /// Executes the order of a line.  The answer is `ok` and its result, or `error` and the message
    /// of its exception.
    using Handler = std::function<std::string(const std::string& line)>;

    static constexpr std::size_t kLongestLine = 4096;
    static constexpr std::size_t kMostClients = 8;
    static constexpr std::size_t kMostUnread = 1U << 20U;  ///< Bytes kept for one client.

    /// Checks, without changing anything, that a socket can be bound at `path`.
    /// @throws InputError  the path is taken, too long, or not in a directory.
    static void require_place(const std::filesystem::path& path);

    /// @throws InputError         as require_place(); the socket cannot be bound.
    /// @throws std::system_error  no socket can be made; names the path.
    ControlSocket(std::filesystem::path path, Handler handler);
    ~ControlSocket() override;
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    void serve(const device::Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const device::Instant& now,
                                       const ClockScale& clock) const override;

private:
    struct Client {
        int descriptor = -1;
        std::string in, out;
    };
    void greet();
    [[nodiscard]] bool read(Client& client) const;  ///< Returns false when the client is gone.
    [[nodiscard]] bool write(Client& client) const;
    [[nodiscard]] std::string answer(const std::string& line) const;

    std::filesystem::path path_;
    Handler handler_;
    int listener_ = -1;
    dev_t device_ = 0;  ///< With inode_: identity of the file made here.
    ino_t inode_ = 0;
    std::vector<Client> clients_;
};

/// Actions for the orders of the control socket.
struct ControlActions {
    std::function<std::string()> status;      ///< Returns the report so far, in one line.
    std::function<void()> edge;               ///< Gives an edge at the device's pin EXT.
    std::function<void()> quit;               ///< Ends the emulator, as SIGTERM does.
    std::function<void(const Fault&)> fault;  ///< Applies the fault now.
};

/// Executes an order: `status`, `edge`, `quit`, or a fault with the names of a script, such as
/// `flip_bit count=3`.
/// @return the answer of `status`, otherwise empty.
/// @throws InputError  as parse_fault(); also every exception of the action.
[[nodiscard]] std::string execute(const std::string& line, const ControlActions& actions,
                                  const FaultRules& rules);

}  // namespace a351::sim::line
