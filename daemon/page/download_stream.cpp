#include "daemon/page/download_stream.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "daemon/page/guard.hpp"
#include "daemon/page/live_stream.hpp"

namespace a351::daemon::page {
namespace {

using std::chrono::steady_clock;

// Bytes per second.  Reason: a memory card that gives 20 MB/s still has time for the recorder, and a
// day of 100 MB takes ten seconds.
constexpr std::uint64_t kRate = 10'000'000;
// Real time for a piece.  Reason: a slow memory stick stops a client for tens of seconds.
constexpr std::chrono::seconds kPatience{120};
constexpr int kLowestPriority = 19;

/// Runs a task, which must outlive it.
template <typename Result>
asio::awaitable<Result> run(const std::function<Result()>& task) {
    co_return task();
}

}  // namespace

DownloadStream::DownloadStream(std::size_t& running) : running_(running) {
    // Not SCHED_IDLE: a thread that gets no time while it holds a lock of the file system would stop
    // the recorder.
    asio::post(pool_, [] {
        const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
        static_cast<void>(::setpriority(PRIO_PROCESS, thread, kLowestPriority));
    });
}

asio::awaitable<std::optional<Response>> DownloadStream::serve(
    beast::tcp_stream& stream, const Request& request, const std::function<Download()>& make) {
    if (request.method != "GET") {
        auto response = refusal(405, request.method + " is not allowed here");
        response.headers.emplace_back("Allow", "GET");
        co_return response;
    }
    if (running_ >= kMost)
        co_return refusal(503, text::message("the day is already being copied twice; try again "
                                             "when one copy is complete"));
    const Seat seat(running_);
    Download download;
    std::uint64_t size = 0;
    try {
        download = make();
        size = co_await asio::co_spawn(pool_, run(download.open), asio::use_awaitable);
    } catch (const std::exception& error) {
        co_return refusal(500, error.what());
    }
    try {
        co_await send(stream, download, size);
    } catch (const std::exception&) {  // Its maker has reported it; the client gets too few bytes.
    }
    stream.close();
    co_return std::nullopt;
}

asio::awaitable<void> DownloadStream::send(beast::tcp_stream& stream, const Download& download,
                                           std::uint64_t size) {
    http::response<http::buffer_body> message;
    message.set(http::field::content_type, "application/x-tar");
    message.set(http::field::content_disposition, "attachment; filename=\"" + download.name + "\"");
    for (const auto& [name, value] : security_headers()) message.set(name, value);
    message.keep_alive(false);
    message.content_length(size);
    message.body().data = nullptr;
    message.body().more = true;
    http::response_serializer<http::buffer_body> serializer(message);
    error_code error;
    stream.expires_after(kPatience);
    co_await http::async_write_header(stream, serializer, into(error));
    asio::steady_timer pause(co_await asio::this_coro::executor);
    auto due = steady_clock::now();
    while (!error && message.body().more) {
        std::string piece = co_await asio::co_spawn(pool_, run(download.next), asio::use_awaitable);
        message.body().data = piece.data();
        message.body().size = piece.size();
        message.body().more = !piece.empty();
        stream.expires_after(kPatience);
        co_await http::async_write(stream, serializer, into(error));
        if (error == http::error::need_buffer) error = {};
        due = std::max(due, steady_clock::now()) +
              std::chrono::microseconds(piece.size() * 1'000'000 / kRate);
        pause.expires_at(due);
        error_code ended;
        co_await pause.async_wait(into(ended));
    }
}

}  // namespace a351::daemon::page
