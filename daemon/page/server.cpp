#include "daemon/page/server.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "daemon/page/asio.hpp"
#include "daemon/page/download_stream.hpp"
#include "daemon/page/guard.hpp"
#include "daemon/page/live_stream.hpp"
#include "daemon/page/seats.hpp"

namespace a351::daemon::page {
namespace {

constexpr std::uint32_t kHeaderLimit = 8 * 1024;
constexpr std::uint64_t kBodyLimit = std::uint64_t{16} * 1024;
constexpr std::string_view kLivePath = "/live";
constexpr std::string_view kBundlePath = "/api/bundle";
constexpr std::size_t kMostTurnedAway = Seats::kMost;
// From accepting a connection to the end of its first header: a request of a slow network takes
// less than a second.
constexpr std::chrono::milliseconds kFirstHeader{2000};
constexpr std::chrono::seconds kRefusalLinger{1};
constexpr std::chrono::milliseconds kAcceptPause{100};

/// @param socket  the connection; one that is broken counts as that of another host.
Request plain(const HttpRequest& message, const tcp::socket& socket) {
    Request request{
        std::string(message.method_string()), std::string(message.target()), {}, message.body()};
    error_code error;
    const auto own = socket.local_endpoint(error);
    if (!error) {
        request.address = config::to_string(
            {.ip = own.address().to_string(), .port = own.port(), .is_v6 = own.address().is_v6()});
    }
    const auto client = socket.remote_endpoint(error);
    request.is_local = !error && client.address().is_loopback();
    for (const auto& field : message)
        request.headers.emplace_back(std::string(field.name_string()), std::string(field.value()));
    return request;
}

http::response<http::string_body> packed(Response response, unsigned version, bool keep_alive,
                                         bool is_head) {
    http::response<http::string_body> message;
    message.version(version);
    message.result(static_cast<unsigned>(response.status));
    message.set(http::field::content_type, response.content_type);
    for (const auto& [name, value] : security_headers()) message.set(name, value);
    for (const auto& [name, value] : response.headers) message.set(name, value);
    message.keep_alive(keep_alive);
    message.content_length(response.body.size());
    if (!is_head) message.body() = std::move(response.body);
    return message;
}

/// Returns the answer to a request that could not be read; std::nullopt if the client is gone.
std::optional<Response> complaint(error_code error) {
    if (error == http::error::header_limit) return refusal(431, "the header is larger than 8 KiB");
    if (error == http::error::body_limit) return refusal(413, "the body is larger than 16 KiB");
    if (error == beast::error::timeout || error == http::error::end_of_stream ||
        error == http::error::partial_message ||
        error.category() != make_error_code(http::error::bad_method).category()) {
        return std::nullopt;
    }
    return refusal(400, "not an HTTP request: " + error.message());
}

}  // namespace

class Server::Impl {
public:
    Impl(const ServerOptions& options, ApiSources sources)
        : options_(options), listen_(options.listen) {
        bind();
        const std::string token = options.token.empty() ? random_token() : options.token;
        guard_.emplace(port_, options.hosts, token, options.boxes);
        const live::Record& live = sources.live;
        sources.is_token_configured = !options.token.empty();
        bundle_ = sources.bundle;
        api_.emplace(std::move(sources), token,
                     config::to_string({.ip = listen_.ip, .port = port_, .is_v6 = listen_.is_v6}));
        live_.emplace(io_, live, *api_, options.stream_patience);
    }

    ~Impl() { stop(); }

    void start() {
        for (auto& acceptor : acceptors_) asio::co_spawn(io_, accept_all(acceptor), asio::detached);
        asio::co_spawn(io_, live_->feed(), asio::detached);
        thread_ = std::thread([this] { io_.run(); });
    }

    void post(std::function<void()> task) { asio::post(io_, std::move(task)); }

    void stop() noexcept {
        io_.stop();
        if (thread_.joinable()) thread_.join();
    }

    std::uint16_t port_ = 0;
    std::vector<std::string> addresses_;

    [[nodiscard]] bool is_exposed() const noexcept { return !listen_.is_loopback; }

private:
    void bind() {
        const auto ip = asio::ip::make_address(listen_.ip);
        error_code error = listen_on({ip, listen_.port});
        if (error) throw std::system_error(error, "[page] listen = " + config::to_string(listen_));
        port_ = acceptors_.front().local_endpoint().port();

        asio::ip::address other;
        if (listen_.ip == "127.0.0.1") other = asio::ip::address_v6::loopback();
        if (listen_.ip == "::1") other = asio::ip::address_v4::loopback();
        if (other.is_unspecified()) return;
        error = listen_on({other, port_});
        // A host without this address family is accepted.  Any other error is thrown, because
        // another program may listen where the browser looks for this daemon.
        if (error && error != asio::error::address_family_not_supported &&
            error != boost::system::errc::address_not_available) {
            throw std::system_error(error, "[page] listen, " + other.to_string());
        }
    }

    error_code listen_on(const tcp::endpoint& endpoint) {
        error_code error;
        tcp::acceptor acceptor(io_);
        acceptor.open(endpoint.protocol(), error);
        if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
        if (!error && endpoint.protocol() == tcp::v6())
            acceptor.set_option(asio::ip::v6_only(true), error);
        if (!error) acceptor.bind(endpoint, error);
        if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
        if (error) return error;
        const auto bound = acceptor.local_endpoint();
        addresses_.push_back(
            config::to_string(config::ListenAddress{.ip = bound.address().to_string(),
                                                    .port = bound.port(),
                                                    .is_v6 = bound.address().is_v6()}));
        acceptors_.push_back(std::move(acceptor));
        return {};
    }

    asio::awaitable<void> accept_all(tcp::acceptor& acceptor) {
        for (;;) {
            error_code error;
            tcp::socket socket(io_);
            co_await acceptor.async_accept(socket, into(error));
            if (!error) {
                welcome(std::move(socket));
                continue;
            }
            // Usually there are no free descriptors; the pause lets some become free.
            asio::steady_timer pause(io_, kAcceptPause);
            co_await pause.async_wait(into(error));
        }
    }

    void welcome(tcp::socket socket) {
        error_code error;
        socket.set_option(tcp::no_delay(true), error);
        const auto client = socket.remote_endpoint(error);
        if (error) return;
        const auto stream = std::make_shared<beast::tcp_stream>(std::move(socket));
        // The seat does not own the stream: seats_ ends after io_, which a stream needs.
        const auto place = seats_.seat({.address = client.address().to_string(),
                                        .is_loopback = client.address().is_loopback(),
                                        .leave = [seated = std::weak_ptr(stream)] {
                                            if (const auto open = seated.lock()) open->close();
                                        }});
        if (place != seats_.end()) {
            asio::co_spawn(io_, hold_seat(stream, place), asio::detached);
        } else if (turned_away_ < kMostTurnedAway) {
            // A connection that is refused also needs a socket for a moment.
            asio::co_spawn(io_, turn_away(stream, Seat(turned_away_)), asio::detached);
        }
    }

    asio::awaitable<void> hold_seat(std::shared_ptr<beast::tcp_stream> stream, Seats::Place place) {
        struct Leave {
            Seats& seats;
            Seats::Place place;
            ~Leave() { seats.leave(place); }
        } const leave{seats_, place};
        const Seat seat(api_->use().connections);
        co_await serve(*stream, place);
    }

    static asio::awaitable<void> turn_away(std::shared_ptr<beast::tcp_stream> stream, Seat) {
        co_await refuse(*stream, refusal(503, "too many connections; try again later"));
    }

    asio::awaitable<void> serve(beast::tcp_stream& stream, Seats::Place place) {
        auto header_limit = std::min(kFirstHeader, options_.request_limit);
        beast::flat_buffer buffer(kHeaderLimit + kBodyLimit);
        for (;;) {
            http::request_parser<http::string_body> parser;
            parser.header_limit(kHeaderLimit);
            parser.body_limit(kBodyLimit);
            error_code error;
            stream.expires_after(std::exchange(header_limit, options_.request_limit));
            co_await http::async_read_header(stream, buffer, parser, into(error));
            if (!error && !parser.is_done()) {
                stream.expires_after(options_.request_limit);
                co_await http::async_read(stream, buffer, parser, into(error));
            }
            if (place->is_leaving) co_return;
            if (error) {
                const auto trouble = complaint(error);
                if (trouble) co_await refuse(stream, *trouble);
                co_return;
            }
            const auto& message = parser.get();
            const Request request = plain(message, stream.socket());
            auto response = guard_->refuse(request);
            if (!response && request.target == kLivePath) {
                response = refuse_stream(message, place);
                if (!response) {
                    co_await live_->serve(std::move(stream), parser.release(),
                                          Seat(api_->use().streams));
                    co_return;
                }
            }
            if (!response && request.target == kBundlePath) {
                response = refusal(503, "too many live streams; try again later");
                if (seats_.begin_stream(place))
                    response = co_await downloads_.serve(stream, request, bundle_);
                if (!response) co_return;
                place->is_streaming = false;
            }
            if (!response) response = api_->answer(request);
            guard_->show_box(request, *response);
            const auto reply = packed(*std::move(response), message.version(), message.keep_alive(),
                                      request.method == "HEAD");
            stream.expires_after(options_.request_limit);
            seats_.answered(place);
            co_await http::async_write(stream, reply, into(error));
            if (error || !message.keep_alive()) co_return;
        }
    }

    [[nodiscard]] std::optional<Response> refuse_stream(const HttpRequest& message,
                                                        Seats::Place place) {
        if (!asks_for_websocket(message)) {
            auto response = refusal(426, "this path is a WebSocket");
            response.headers.emplace_back("Upgrade", "websocket");
            return response;
        }
        if (seats_.begin_stream(place)) return std::nullopt;
        return refusal(503, "too many live streams; try again later");
    }

    /// Answers and closes.  Further bytes of the client are read and dropped for a moment, because
    /// closing with unread bytes resets the connection and may lose the answer.
    static asio::awaitable<void> refuse(beast::tcp_stream& stream, Response response) {
        error_code error;
        const auto reply = packed(std::move(response), 11, false, false);
        stream.expires_after(kRefusalLinger);
        co_await http::async_write(stream, reply, into(error));
        if (error) co_return;
        stream.socket().shutdown(tcp::socket::shutdown_send, error);
        std::array<char, 4096> dropped{};
        while (!error) co_await stream.async_read_some(asio::buffer(dropped), into(error));
    }

    const ServerOptions options_;
    const config::ListenAddress listen_;
    std::optional<Guard> guard_;
    // Coroutines end with io_ and then free their seats in these members.
    std::optional<Api> api_;
    std::size_t turned_away_ = 0;
    std::size_t downloads_running_ = 0;
    Seats seats_;
    std::function<Download()> bundle_;
    asio::io_context io_{1};
    DownloadStream downloads_{downloads_running_};
    std::optional<LiveStream> live_;
    std::vector<tcp::acceptor> acceptors_;
    std::thread thread_;
};

Server::Server(const ServerOptions& options, ApiSources sources)
    : impl_(std::make_unique<Impl>(options, std::move(sources))) {}
Server::~Server() = default;

void Server::start() { impl_->start(); }
void Server::post(std::function<void()> task) { impl_->post(std::move(task)); }
void Server::stop() noexcept { impl_->stop(); }
std::uint16_t Server::port() const noexcept { return impl_->port_; }
const std::vector<std::string>& Server::addresses() const noexcept { return impl_->addresses_; }
bool Server::is_exposed() const noexcept { return impl_->is_exposed(); }

}  // namespace a351::daemon::page
