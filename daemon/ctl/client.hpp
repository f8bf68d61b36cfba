#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace a351::daemon::ctl {

/// Thrown if nothing answers at the address, or the program that answers is not a351d.
class NoDaemon : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Url {
    std::string host;  ///< Without brackets.
    std::string port = "80";

    [[nodiscard]] std::string authority() const;  ///< Returns host:port for the header Host.
};

/// Reads http://HOST[:PORT][/].
/// @throws InputError  the text has another form.
[[nodiscard]] Url parse_url(std::string_view text);

struct Reply {
    int status = 0;
    std::string body;
};

/// Receives a large file piece by piece.  What these functions throw ends the transfer.
struct Receiver {
    /// @param name  file name that the daemon proposes; empty: none.
    std::function<void(std::uint64_t size, const std::string& name)> begin;
    std::function<void(std::string_view piece)> take;
};

/// Sends requests to the daemon and waits for each answer: to a question at most 2 s, to an order 12 s,
/// and says after 2 s that it waits.
class Client {
public:
    explicit Client(Url url) : url_(std::move(url)) {}

    /// @throws NoDaemon
    [[nodiscard]] Reply get(const std::string& path) const;
    [[nodiscard]] Reply post(const std::string& path, const std::string& json,
                             const std::string& token) const;

    /// Asks for a large file.  The daemon may take a minute before it begins, and for each piece.
    /// @return the refusal, with its status; 200 if all was received.
    /// @throws NoDaemon            nothing answers.
    /// @throws std::runtime_error  the connection ended before the file.
    [[nodiscard]] Reply get_file(const std::string& path, const Receiver& receiver) const;

private:
    Url url_;
};

/// Returns a size as "12.3", MB.
[[nodiscard]] std::string megabytes(std::uint64_t bytes);

}  // namespace a351::daemon::ctl
