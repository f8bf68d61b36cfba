#pragma once
/// @file
/// WebSocket /live.  First a text message {"status": <as GET /api/status>} and the last 60 s of
/// samples; then samples as they come, every 100 ms, and the status once a second and whenever what
/// the operator has to know at once has changed.  Of what a viewer sends nothing is needed.
///
/// All on the thread of the page: viewers wait for messages that are there already, and nobody for
/// a viewer.

#include <chrono>
#include <cstdint>
#include <string>

#include "daemon/live/live_record.hpp"
#include "daemon/page/api.hpp"
#include "daemon/page/asio.hpp"
#include "daemon/page/live_message.hpp"
#include "daemon/page/page_use.hpp"

namespace a351::daemon {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

[[nodiscard]] bool asks_for_websocket(const HttpRequest& request);

class LiveStream {
public:
    /// @param patience  real time after which a viewer that takes or answers nothing is left.
    LiveStream(boost::asio::io_context& io, const LiveRecord& live, Api& api,
               std::chrono::milliseconds patience);

    /// Makes messages as long as there are viewers; does not end.
    boost::asio::awaitable<void> feed();

    /// One viewer, from its request, which has passed the Guard, to its end.
    boost::asio::awaitable<void> serve(boost::beast::tcp_stream stream, HttpRequest request, Seat);

private:
    class Viewer;

    boost::asio::awaitable<void> write_all(std::shared_ptr<Viewer> viewer);
    void take_samples();
    void take_status();

    const LiveRecord& live_;
    Api& api_;
    const std::chrono::milliseconds patience_;
    LiveMessages messages_;
    boost::asio::steady_timer news_;  ///< Cancelled when there are messages.
    std::uint64_t cursor_ = 0;        ///< Of live_.
    std::string told_;                ///< Api::urgent_status() of the last one.
    std::chrono::steady_clock::time_point next_status_{};
};

}  // namespace a351::daemon
