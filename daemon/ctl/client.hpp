#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace a351::daemon {

/// Nobody answers at the address, or what answers is no daemon of ours.
class NoDaemon : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Url {
    std::string host;  ///< Without brackets.
    std::string port = "80";

    [[nodiscard]] std::string authority() const;  ///< host:port, as the header Host wants it.
};

/// Reads http://HOST[:PORT][/].
/// @throws InputError  anything else.
[[nodiscard]] Url parse_url(std::string_view text);

struct Reply {
    int status = 0;
    std::string body;
};

/// Asks the daemon and waits for the answer, 15 s at most.
class Client {
public:
    explicit Client(Url url) : url_(std::move(url)) {}

    /// @throws NoDaemon
    [[nodiscard]] Reply get(const std::string& path) const;
    [[nodiscard]] Reply post(const std::string& path, const std::string& json,
                             const std::string& token) const;

    [[nodiscard]] const Url& url() const noexcept { return url_; }

private:
    Url url_;
};

}  // namespace a351::daemon
