#pragma once
/// @file
/// WebSocket /live.  It sends a text message {"status": <as GET /api/status>} and the last
/// 60 s of samples first, then new samples every 100 ms.  The status is sent once a second, and at
/// once when level, verdict, link or occupation change.  Messages from a viewer are ignored.
///
/// All runs on the thread of the page.  Viewers wait for messages; nothing waits for a viewer.

#include <chrono>
#include <cstdint>
#include <string>

#include "daemon/live/live_record.hpp"
#include "daemon/page/api.hpp"
#include "daemon/page/asio.hpp"
#include "daemon/page/live_message.hpp"

namespace a351::daemon::page {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Returns true for a request to upgrade to WebSocket.
[[nodiscard]] bool asks_for_websocket(const HttpRequest& request);

class LiveStream {
public:
    /// @param patience  real time after which a viewer that accepts or answers nothing is
    ///                  disconnected.
    LiveStream(boost::asio::io_context& io, const live::Record& live, Api& api,
               std::chrono::milliseconds patience);

    /// Makes messages while there are viewers; does not end.
    boost::asio::awaitable<void> feed();

    /// Serves one viewer until it disconnects.  Its request has passed the Guard.
    boost::asio::awaitable<void> serve(boost::beast::tcp_stream stream, HttpRequest request, Seat);

private:
    class Viewer;

    boost::asio::awaitable<void> write_all(std::shared_ptr<Viewer> viewer);
    void take_samples();
    void take_status();

    const live::Record& live_;
    Api& api_;
    const std::chrono::milliseconds patience_;
    LiveMessages messages_;
    boost::asio::steady_timer news_;  ///< Timer that is cancelled when there are new messages.
    boost::asio::steady_timer step_;  ///< Timer of feed(), cancelled by the first viewer.
    std::uint64_t cursor_ = 0;        ///< Position in live_.
    std::string told_;                ///< Api::urgent_status() of the last status sent.
    std::chrono::steady_clock::time_point next_status_{};
};

}  // namespace a351::daemon::page
