#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/line/service.hpp"

namespace a351::sim {

/// A Unix stream socket that takes orders: one line in, one line out, `ok ...` or `error ...`.
/// A client that misbehaves (endless line, no reading, too many) is dropped and harms nobody else.
///
/// The socket's file is removed at the end, if it is still ours.  A socket in its place that
/// refuses connections is replaced, which one that is bound but not yet listened to does too;
/// anything else there stays.
class ControlSocket final : public Service {
public:
    /// What a line asks for.  Returns what follows `ok`; what it throws follows `error`.
    using Handler = std::function<std::string(const std::string& line)>;

    static constexpr std::size_t kLongestLine = 4096;
    static constexpr std::size_t kMostClients = 8;
    static constexpr std::size_t kMostUnread = 1U << 20U;  ///< Bytes kept for one client.

    /// A socket can be bound there, as far as can be told without doing anything.
    /// @throws InputError  the path is taken, too long, or in no directory.
    static void require_place(const std::filesystem::path& path);

    /// @throws InputError         as require_place; the socket cannot be bound.
    /// @throws std::system_error  naming the path.
    ControlSocket(std::filesystem::path path, Handler handler);
    ~ControlSocket() override;
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    void serve(const Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const Instant& now, const ClockScale& clock) const override;

private:
    struct Client {
        int descriptor = -1;
        std::string in, out;
    };
    void greet();
    [[nodiscard]] bool attend(Client& client) const;  ///< False: it is gone.
    [[nodiscard]] bool read(Client& client) const;
    [[nodiscard]] bool write(Client& client) const;
    [[nodiscard]] std::string answer(const std::string& line) const;

    std::filesystem::path path_;
    Handler handler_;
    int listener_ = -1;
    dev_t device_ = 0;  ///< With inode_: the file that is ours.
    ino_t inode_ = 0;
    std::vector<Client> clients_;
};

}  // namespace a351::sim
