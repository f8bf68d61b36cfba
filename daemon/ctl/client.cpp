#include "daemon/ctl/client.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <limits>
#include <vector>

#include "daemon/page/asio.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {
namespace {

namespace asio = page::asio;
namespace beast = page::beast;
namespace http = page::http;
using page::error_code;
using page::into;

// Longest wait for an answer; after it the operator reads that the order is still waiting.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::chrono::seconds kPatience{15};
#else
constexpr std::chrono::seconds kPatience{2};
#endif
// Time limit of an order.  It exceeds that of the daemon for its disk, 10 s, whose message then
// arrives first.
constexpr std::chrono::seconds kOrderPatience = kPatience + std::chrono::seconds(10);
// Time limit of a large file, until it begins and for each piece.  The daemon may first have to wait
// for its disk; a slow memory stick is no delay of the daemon.
constexpr std::chrono::seconds kFilePatience{60};

/// Orders change something; the others only ask.
bool is_order(const http::request<http::string_body>& request) {
    return request.method() == http::verb::post;
}

constexpr std::uint64_t kLargestAnswer = std::uint64_t{64} * 1024 * 1024;

/// Connects to the daemon and sends a request.
/// @param patience      time for the request and its answer, from now on set in `stream`.
/// @param is_connected  set when the daemon's host has answered.
asio::awaitable<void> send(const Url& url, const http::request<http::string_body>& request,
                           std::chrono::seconds patience, beast::tcp_stream& stream,
                           error_code& error, bool& is_connected) {
    asio::ip::tcp::resolver resolver(stream.get_executor());
    const auto places = co_await resolver.async_resolve(url.host, url.port, into(error));
    if (error) co_return;
    stream.expires_after(kPatience);
    co_await stream.async_connect(places, into(error));
    if (error) co_return;
    is_connected = true;
    stream.expires_after(patience);
    stream.socket().set_option(asio::ip::tcp::no_delay(true), error);
    co_await http::async_write(stream, request, into(error));
    // A daemon that refuses the request may close before it has read all of it.  Its answer is
    // used, not the error of the write.
    error = {};
}

asio::awaitable<void> exchange(const Url& url, const http::request<http::string_body>& request,
                               std::chrono::seconds patience,
                               http::response_parser<http::string_body>& answer, error_code& error,
                               bool& is_connected) {
    beast::tcp_stream stream(co_await asio::this_coro::executor);
    co_await send(url, request, patience, stream, error, is_connected);
    if (error) co_return;
    beast::flat_buffer buffer;
    co_await http::async_read(stream, buffer, answer, into(error));
}

/// Returns why a daemon gives no answer.
std::string reason(const Url& url, const error_code& error, bool is_connected,
                   std::chrono::seconds patience, bool is_order) {
    const std::string place = url.authority();
    if (error != beast::error::timeout || !is_connected)
        return text::tr("no daemon answers at http://{}: {}; check that a351d is running", place,
                        error.message());
    if (is_order)
        return text::tr(
            "the daemon at http://{} gave no answer within {} s; it may still carry this out: look "
            "at a351ctl list before you repeat it",
            place, patience.count());
    return text::tr("the daemon at http://{} gave no answer within {} s; try again", place,
                    patience.count());
}

/// Says that the answer to an order is late: a disk that stalls delays it.
/// @param is_connected  see exchange(); without a connection no order was sent.
asio::awaitable<void> say_if_late(const Url& url, const bool& is_connected) {
    asio::steady_timer late(co_await asio::this_coro::executor, kPatience);
    error_code ended;
    co_await late.async_wait(into(ended));
    if (!is_connected) co_return;
    fmt::print(
        stderr, "a351ctl: {}\n",
        text::tr("no answer from http://{} yet, its disk may be busy: waiting", url.authority()));
}

void complete(const Url& url, http::request<http::string_body>& request) {
    request.set(http::field::host, url.authority());
    request.set(http::field::user_agent, "a351ctl/" A351_VERSION);
    request.keep_alive(false);
    request.prepare_payload();
}

/// Returns the name of `attachment; filename="NAME"`, without folders.
std::string proposed_name(std::string_view disposition) {
    constexpr std::string_view kBefore = "filename=\"";
    const auto at = disposition.find(kBefore);
    if (at == std::string_view::npos) return {};
    const auto name = disposition.substr(at + kBefore.size());
    return std::filesystem::path(name.substr(0, name.find('"'))).filename().string();
}

/// Receives the body of an answer, whose header has been read.
asio::awaitable<void> receive(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                              http::response_parser<http::buffer_body>& parser,
                              const Receiver& receiver, Reply& reply, error_code& error) {
    auto& answer = parser.get();
    reply.status = static_cast<int>(answer.result_int());
    const bool is_good = answer.result() == http::status::ok;
    const std::uint64_t size = parser.content_length().value_or(0);
    if (is_good)
        receiver.begin(size, proposed_name(std::string(answer[http::field::content_disposition])));
    std::vector<char> piece(std::size_t{64} * 1024);
    std::uint64_t done = 0;
    while (!error && !parser.is_done()) {
        answer.body().data = piece.data();
        answer.body().size = piece.size();
        stream.expires_after(kFilePatience);
        co_await http::async_read(stream, buffer, parser, into(error));
        if (error == http::error::need_buffer) error = {};
        const std::string_view bytes(piece.data(), piece.size() - answer.body().size);
        done += bytes.size();
        if (is_good)
            receiver.take(bytes);
        else
            reply.body += bytes;
    }
    if (error)
        throw std::runtime_error(
            text::tr("the daemon ended the transfer after {} of {} MB; see its log, and try again",
                     megabytes(done), megabytes(size)));
}

asio::awaitable<void> download(const Url& url, const http::request<http::string_body>& request,
                               const Receiver& receiver, Reply& reply) {
    beast::tcp_stream stream(co_await asio::this_coro::executor);
    error_code error;
    bool is_connected = false;
    co_await send(url, request, kFilePatience, stream, error, is_connected);
    beast::flat_buffer buffer;
    http::response_parser<http::buffer_body> parser;
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());
    if (!error) co_await http::async_read_header(stream, buffer, parser, into(error));
    if (error) throw NoDaemon(reason(url, error, is_connected, kFilePatience, false));
    co_await receive(stream, buffer, parser, receiver, reply, error);
}

Reply ask(const Url& url, http::request<http::string_body> request) {
    complete(url, request);

    http::response_parser<http::string_body> answer;
    answer.body_limit(kLargestAnswer);
    error_code error;
    bool is_connected = false;
    asio::io_context io(1);
    if (is_order(request)) asio::co_spawn(io, say_if_late(url, is_connected), asio::detached);
    const auto patience = is_order(request) ? kOrderPatience : kPatience;
    asio::co_spawn(io, exchange(url, request, patience, answer, error, is_connected),
                   [&](const std::exception_ptr&) { io.stop(); });
    io.run();
    if (error) throw NoDaemon(reason(url, error, is_connected, patience, is_order(request)));
    return {static_cast<int>(answer.get().result_int()), std::move(answer.get().body())};
}

}  // namespace

std::string megabytes(std::uint64_t bytes) {
    return fmt::format("{:.1f}", static_cast<double>(bytes) / 1e6);
}

std::string Url::authority() const {
    const bool is_v6 = host.find(':') != std::string::npos;
    return is_v6 ? fmt::format("[{}]:{}", host, port) : host + ":" + port;
}

Url parse_url(std::string_view text) {
    const auto refuse = [&]() {
        throw InputError(
            fmt::format("--url = {}: not an address; allowed: http://HOST:PORT", text));
    };
    constexpr std::string_view kScheme = "http://";
    if (!text.starts_with(kScheme)) refuse();
    auto rest = text.substr(kScheme.size());
    if (rest.ends_with('/')) rest.remove_suffix(1);
    Url url;
    if (rest.starts_with('[')) {
        const auto bracket = rest.find(']');
        if (bracket == std::string_view::npos) refuse();
        url.host = std::string(rest.substr(1, bracket - 1));
        rest.remove_prefix(bracket + 1);
    } else {
        const auto end = std::min(rest.find(':'), rest.size());
        url.host = std::string(rest.substr(0, end));
        rest.remove_prefix(end);
    }
    if (rest.starts_with(':')) {
        url.port = std::string(rest.substr(1));
        rest = "";
    }
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const bool is_number =
        !url.port.empty() && url.port.size() <= 5 && std::ranges::all_of(url.port, is_digit);
    const bool is_clean = std::ranges::all_of(
        url.host, [](char c) { return c > ' ' && c < '\x7f' && c != '/' && c != '@'; });
    if (url.host.empty() || !rest.empty() || !is_number || !is_clean) refuse();
    return url;
}

Reply Client::get(const std::string& path) const {
    return ask(url_, http::request<http::string_body>(http::verb::get, path, 11));
}

Reply Client::get_file(const std::string& path, const Receiver& receiver) const {
    http::request<http::string_body> request(http::verb::get, path, 11);
    complete(url_, request);
    Reply reply;
    std::exception_ptr failure;
    asio::io_context io(1);
    asio::co_spawn(io, download(url_, request, receiver, reply),
                   [&](const std::exception_ptr& thrown) { failure = thrown; });
    io.run();
    if (failure) std::rethrow_exception(failure);
    return reply;
}

Reply Client::post(const std::string& path, const std::string& json,
                   const std::string& token) const {
    http::request<http::string_body> request(http::verb::post, path, 11, json);
    request.set(http::field::content_type, "application/json");
    request.set("X-A351-Token", token);
    return ask(url_, std::move(request));
}

}  // namespace a351::daemon::ctl
