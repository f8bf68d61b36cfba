#pragma once

#include <poll.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace a351::sim::line {

/// A pseudo-terminal whose other side acts as the serial port: raw, non-blocking, with a symbolic
/// link to it.  It keeps its own slave descriptor open, so that hosts can connect and disconnect.
///
/// The link is removed at the end, if it is still the one made here.  An existing link is replaced
/// if it leads to a missing terminal in /dev/pts: an emulator that was killed left it.  Anything
/// else at the path is kept.
class Pty {
public:
    /// Checks, without changing anything, that the link can be made.
    /// @throws InputError  something else is there and may not be replaced; no such directory.
    static void require_place(const std::filesystem::path& link);

    /// @param baud  baud rate until a host sets another.
    /// @throws InputError         as require_place(); the link cannot be made.
    /// @throws std::system_error  an operation failed; names the operation and the path.
    explicit Pty(std::filesystem::path link, int baud = 460800);
    ~Pty();
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& slave_path() const noexcept { return terminal_->path; }

    /// Returns bytes that the host has written; empty if there are none.
    [[nodiscard]] std::vector<std::byte> read();

    /// Writes bytes.  @return how many bytes the terminal took; 0 when it is full.
    [[nodiscard]] std::size_t write(std::span<const std::byte> bytes);

    /// Returns the descriptor and events to poll: the host has written something or, with
    /// `for_space`, the terminal takes bytes again.
    [[nodiscard]] pollfd watched(bool for_space) const noexcept;

    /// Returns the baud rate that the host has set; 0 if it is not one of the usual rates.
    [[nodiscard]] int baud() const;

    /// Returns the number of bytes written that the host has not read; 0 only if it has read all.
    /// While the terminal is full, the kernel does not count all of them.
    [[nodiscard]] std::size_t unread() const;

    /// Pulls the adapter out: the host sees its terminal hang up, and the link is removed.
    void hang_up();

    /// Takes back the bytes that the host will not read any more, because the host or this terminal
    /// ends.  Waits 20 ms for more.  @return their number.
    [[nodiscard]] std::size_t discard_unread();

    /// Plugs the adapter in again, as a terminal with another name.
    /// @throws InputError  something else is now at the path of the link.
    void come_back();

private:
    /// Both ends of the terminal; the destructor closes them.
    struct Terminal {
        explicit Terminal(int baud);
        ~Terminal();
        Terminal(const Terminal&) = delete;
        Terminal& operator=(const Terminal&) = delete;
        void open_slave(int baud);

        int master = -1;
        int slave = -1;
        std::string path;
    };

    void remove_link() noexcept;

    std::filesystem::path link_;
    int baud_;
    std::unique_ptr<Terminal> terminal_;
};

}  // namespace a351::sim::line
