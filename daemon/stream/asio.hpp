#pragma once
/// @file
/// Headers and names of Boost.Asio for the connection to a ring.

// Boost 1.74 with g++ 12: the coroutine header uses std::exchange without including it.
#include <utility>
//
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>

namespace a351::daemon::stream {

namespace asio = boost::asio;
using boost::system::error_code;

/// Stores an error instead of throwing it: `co_await async_...(into(error))`.
inline auto into(error_code& error) { return asio::redirect_error(asio::use_awaitable, error); }

}  // namespace a351::daemon::stream
