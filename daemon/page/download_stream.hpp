#pragma once
/// @file
/// Sends files that are made while they are sent.  A thread of its own, with the lowest priority,
/// reads and makes them, so that neither recorder nor page waits.

#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <functional>
#include <optional>

#include "daemon/page/asio.hpp"
#include "daemon/page/message.hpp"

namespace a351::daemon::page {

class DownloadStream {
public:
    static constexpr std::size_t kMost = 2;  ///< Downloads at a time.

    /// @param running  counts the downloads; it must outlive their connections.
    explicit DownloadStream(std::size_t& running);

    /// Sends a file.  The connection is to be closed afterwards.
    /// @return the refusal to be sent, if nothing was sent.
    asio::awaitable<std::optional<Response>> serve(beast::tcp_stream& stream,
                                                   const Request& request,
                                                   const std::function<Download()>& make);

private:
    asio::awaitable<void> send(beast::tcp_stream& stream, const Download& download,
                               std::uint64_t size);

    std::size_t& running_;
    asio::thread_pool pool_{1};
};

}  // namespace a351::daemon::page
