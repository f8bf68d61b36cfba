#include "daemon/page/live_stream.hpp"

#include <algorithm>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "daemon/page/guard.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::daemon::page {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::chrono::milliseconds kStep{100};
constexpr std::chrono::seconds kStatusStep{1};
constexpr std::chrono::seconds kLinger{1};
constexpr std::uint64_t kPastSeconds = 60;
constexpr std::size_t kLargestFromClient = std::size_t{4} * 1024;
/// Send buffer in bytes.  By default the kernel stores megabytes for a viewer that does not read.
constexpr int kSendBuffer = 128 * 1024;

LiveMessage text_message(const nlohmann::json& text) {
    return {.is_text = true, .bytes = text::json_text(text)};
}

}  // namespace

bool asks_for_websocket(const HttpRequest& request) { return websocket::is_upgrade(request); }

class LiveStream::Viewer {
public:
    Viewer(beast::tcp_stream stream, std::chrono::milliseconds patience)
        : deadline_(stream.get_executor()), socket_(std::move(stream)) {
        error_code ignored;
        beast::get_lowest_layer(socket_).socket().set_option(
            asio::socket_base::send_buffer_size(kSendBuffer), ignored);
        beast::get_lowest_layer(socket_).expires_never();  // The WebSocket has its own time-outs.
        socket_.set_option(websocket::stream_base::timeout{
            .handshake_timeout = patience, .idle_timeout = patience, .keep_alive_pings = true});
        socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& reply) {
            for (const auto& [name, value] : security_headers()) reply.set(name, value);
        }));
        socket_.read_message_max(kLargestFromClient);
        socket_.auto_fragment(false);
    }

    /// Closes the connection if this time passes before the next call.
    static void give(const std::shared_ptr<Viewer>& viewer, std::chrono::milliseconds time) {
        viewer->deadline_.expires_after(time);
        viewer->deadline_.async_wait([viewer](error_code error) {
            if (!error) beast::get_lowest_layer(viewer->socket_).close();
        });
    }

    asio::steady_timer deadline_;
    websocket::stream<beast::tcp_stream> socket_;
    bool is_over_ = false;
};

LiveStream::LiveStream(asio::io_context& io, const live::Record& live, Api& api,
                       std::chrono::milliseconds patience)
    : live_(live),
      api_(api),
      patience_(patience),
      news_(io, asio::steady_timer::time_point::max()),
      step_(io) {}

asio::awaitable<void> LiveStream::feed() {
    for (;;) {
        error_code error;
        if (api_.use().streams == 0)
            step_.expires_at(asio::steady_timer::time_point::max());
        else
            step_.expires_after(kStep);
        co_await step_.async_wait(into(error));
        if (api_.use().streams == 0) continue;
        take_samples();
        take_status();
    }
}

void LiveStream::take_samples() {
    while (const auto block = live_.block_from(cursor_, kMostSamplesPerMessage))
        messages_.push({.bytes = encoded(*block)});
    news_.cancel();
}

void LiveStream::take_status() {
    auto urgent = api_.urgent_status();
    const auto now = std::chrono::steady_clock::now();
    if (!urgent || (*urgent == told_ && now < next_status_)) return;
    const auto status = api_.live_status();
    if (!status) return;
    told_ = *std::move(urgent);
    next_status_ = now + kStatusStep;
    messages_.push(text_message(*status));
    news_.cancel();
}

asio::awaitable<void> LiveStream::serve(beast::tcp_stream stream, HttpRequest request, Seat) {
    if (api_.use().streams == 1) {  // Nobody looked, so no messages were made.
        cursor_ = live_.end();
        step_.cancel();
    }
    const auto viewer = std::make_shared<Viewer>(std::move(stream), patience_);
    error_code error;
    co_await viewer->socket_.async_accept(request, into(error));
    if (error) co_return;
    asio::co_spawn(co_await asio::this_coro::executor, write_all(viewer), asio::detached);
    beast::flat_buffer unread;
    while (!error) {
        co_await viewer->socket_.async_read(unread, into(error));
        unread.clear();
    }
    viewer->is_over_ = true;
    viewer->deadline_.cancel();
    news_.cancel();
}

asio::awaitable<void> LiveStream::write_all(std::shared_ptr<Viewer> viewer) {
    // New samples go to the viewers that exist already; this one gets them with its past.
    take_samples();
    std::uint64_t position = messages_.end();
    const std::uint64_t present = cursor_;
    std::uint64_t past =
        present - std::min(present, kPastSeconds * static_cast<std::uint64_t>(live_.rate_hz()));
    error_code error;
    std::shared_ptr<const LiveMessage> message;
    if (const auto status = api_.live_status())
        message = std::make_shared<const LiveMessage>(text_message(*status));
    while (!viewer->is_over_) {
        if (message) {
            Viewer::give(viewer, patience_);
            viewer->socket_.text(message->is_text);
            co_await viewer->socket_.async_write(asio::buffer(message->bytes), into(error));
            viewer->deadline_.cancel();
            if (error) break;
        }
        message.reset();
        if (past < present) {
            const auto block = live_.block_from(
                past, std::min<std::uint64_t>(kMostSamplesPerMessage, present - past));
            // If the viewer was so slow that its past is gone, it continues with the messages.
            if (block && past <= present) {
                message =
                    std::make_shared<const LiveMessage>(LiveMessage{.bytes = encoded(*block)});
            } else {
                past = present;
            }
            continue;
        }
        message = messages_.next(position, api_.use().messages_dropped);
        if (!message) co_await news_.async_wait(into(error));
    }
    // The reader ends with the same error, or when the connection is closed.
    if (!viewer->is_over_) Viewer::give(viewer, kLinger);
}

}  // namespace a351::daemon::page
