#pragma once

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

/// Sends requests to the daemon and waits for each answer: to a question at most 2 s, to an order 12 s,
/// and says after 2 s that it waits.
class Client {
public:
    explicit Client(Url url) : url_(std::move(url)) {}

    /// @throws NoDaemon
    [[nodiscard]] Reply get(const std::string& path) const;
    [[nodiscard]] Reply post(const std::string& path, const std::string& json,
                             const std::string& token) const;

private:
    Url url_;
};

}  // namespace a351::daemon::ctl
