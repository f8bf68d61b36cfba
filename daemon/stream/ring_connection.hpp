#pragma once
/// @file
/// Connection to a ringserver, or another server of the DataLink protocol.
///
///     RingConnection ring(executor);
///     co_await ring.open({"ring.example", "16000"});
///     const auto ends = co_await ring.latest(names);       // ID of each stream's last packet
///     const std::string bytes = co_await ring.read(ends.at("XX_A351_00_BNZ"));
///     const auto ids = co_await ring.write(records);
///
/// Every exchange ends within 10 s; the name lookup has the resolver's own limit.  All members throw RingError; the connection is useless then.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "daemon/stream/asio.hpp"
#include "daemon/stream/datalink.hpp"

namespace a351::daemon::stream {

struct Address {
    std::string host;  ///< Name or address, without brackets.
    std::string port = "16000";

    [[nodiscard]] std::string text() const;  ///< Returns HOST:PORT.
};

/// Reads HOST[:PORT], or [ADDRESS][:PORT] for IPv6.  The default port is 16000, that of ringserver's
/// documentation.
/// @throws InputError  the text has another form; names RING.
[[nodiscard]] Address parse_address(std::string_view text);

class RingConnection {
public:
    explicit RingConnection(asio::any_io_executor executor) : stream_(std::move(executor)) {}

    /// Connects and says who writes.
    asio::awaitable<void> open(const Address& address);

    /// Returns the IDs of the packets that the ring received last, by stream.  Streams that are not
    /// in the ring are absent.
    /// @param names  streams to look for, as NET_STA_LOC_CHAN.
    asio::awaitable<std::map<std::string, std::uint64_t>> latest(
        const std::vector<std::string>& names);

    /// Returns the ID of the oldest packet of the ring; 0 if it is empty.
    asio::awaitable<std::uint64_t> earliest();

    /// Returns the data of a packet.
    asio::awaitable<std::string> read(std::uint64_t id);

    /// Writes records and waits until the ring has acknowledged each.  After an error some of them
    /// may be in the ring.
    /// @return their packet IDs.
    asio::awaitable<std::vector<std::uint64_t>> write(std::span<const Record> records);

private:
    struct Answer {
        AnswerHeader header;
        std::string data;
    };
    asio::awaitable<void> send(const std::string& bytes);
    asio::awaitable<std::string> receive(std::size_t size);
    asio::awaitable<Answer> answer(std::string_view kind);
    asio::awaitable<Answer> ask(const std::string& request, std::string_view kind);

    boost::beast::tcp_stream stream_;
};

}  // namespace a351::daemon::stream
