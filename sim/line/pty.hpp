#pragma once

#include <poll.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace a351::sim {

/// A pseudo-terminal whose other side plays the serial port: raw, never blocking, named by a
/// symbolic link.  It holds its own slave descriptor open, so that a host may come and go.
///
/// The link is removed at the end, if it is still ours.  An older link in its place is replaced if
/// it dangles and points into /dev/pts: somebody was killed.  Anything else there stays.
class Pty {
public:
    /// The link can be made, as far as can be told without doing anything.
    /// @throws InputError  it exists and is not ours; there is no such directory.
    static void require_place(const std::filesystem::path& link);

    /// @param baud  speed until a host sets another.
    /// @throws InputError         as require_place; the link cannot be made.
    /// @throws std::system_error  naming the operation and the path.
    explicit Pty(std::filesystem::path link, int baud = 460800);
    ~Pty();
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& slave_path() const noexcept { return terminal_.path; }

    /// What the host has written so far; empty if nothing.
    [[nodiscard]] std::vector<std::byte> read();

    /// @return how many bytes the terminal took, 0 when it is full.
    [[nodiscard]] std::size_t write(std::span<const std::byte> bytes);

    /// What stirs when the host has written something or, if `for_space`, when the terminal takes
    /// bytes again.
    [[nodiscard]] pollfd watched(bool for_space) const noexcept;

    /// Speed that the host has set; 0 when it is none of the usual ones.
    [[nodiscard]] int baud() const;

    /// Bytes written that the host has not read, as far as the kernel tells: those written last may
    /// not count yet.
    [[nodiscard]] std::size_t unread() const;

    /// The adapter is pulled out: the host sees its terminal hang up, and the link is gone.
    void hang_up();

    /// Bytes written that the host will never read: takes them back, which needs the host to have
    /// come to its end, or ours.  Waits 20 ms for more.
    [[nodiscard]] std::size_t take_back();

    /// The adapter is back, as a terminal of another name.
    /// @throws InputError  something else has taken the place of the link.
    void come_back();

private:
    /// Both ends; closed with it.
    struct Terminal {
        explicit Terminal(int baud);
        ~Terminal();
        Terminal(const Terminal&) = delete;
        Terminal& operator=(const Terminal&) = delete;
        void swap(Terminal& other) noexcept;
        void open_slave(int baud);

        int master = -1;
        int slave = -1;
        std::string path;
    };

    void make_link();
    void remove_link() noexcept;

    std::filesystem::path link_;
    int baud_;
    Terminal terminal_;
};

}  // namespace a351::sim
