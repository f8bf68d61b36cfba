#pragma once
/// @file
/// Seats for the connections of the page, so that no client can take them all.
///
/// A connection gets a seat when it is accepted and leaves it when it ends.  A newer connection may
/// take the seat of one whose client is slow with a request or with reading the answer, but not
/// that of a live stream.  Streams have limits of their own.

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace a351::daemon::page {

/// Returns the name under which connections from this address share their seats: the address, or of
/// a global IPv6 address the subnet, its first 64 bits.  A host chooses addresses in its subnet as
/// it likes (RFC 4291, 2.5.1).  Private and link-local addresses count singly, as IPv4 does (also
/// mapped): all telephones of one Wi-Fi share the subnet.
[[nodiscard]] std::string host_of(const boost::asio::ip::address& address);

/// The seats and their holders.  One thread at a time.
class Seats {
public:
    static constexpr std::size_t kMost = 32;         ///< Bounds the cost of a client that leaks.
    static constexpr std::size_t kOfOneHost = 16;    ///< One other host; a browser takes six.
    static constexpr std::size_t kForLoopback = 2;   ///< Seats of no other host: a351ctl and page.
    static constexpr std::size_t kMostStreams = 20;  ///< Part of the seats; 12 are for requests.
    static constexpr std::size_t kStreamsOfOneHost = 8;  ///< One other host; a page takes one.

    struct Holder {
        std::string host;  ///< host_of() the client.
        bool is_loopback = false;
        std::function<void()> leave;  ///< Closes the connection; it is called at most once.
        bool is_streaming = false;    ///< It does not have to make room.
        bool is_leaving = false;      ///< The seat was given to another connection.
    };
    using Place = std::list<Holder>::iterator;

    /// Seats a connection.  If there is no seat for it, the holder leaves whose client has been
    /// waited for longest: of the same host, if that one has all its seats; else of any.
    /// @return end() if nobody can leave.
    [[nodiscard]] Place seat(Holder holder);
    [[nodiscard]] Place end() { return holders_.end(); }

    /// Notes that a holder gets its answer: from now on it is waited for.
    void answered(Place place) { holders_.splice(holders_.end(), holders_, place); }

    /// Makes a holder a live stream.  Two streams are kept for loopback.
    /// @return false if there are too many, in all or of this host.
    [[nodiscard]] bool begin_stream(Place place);

    void leave(Place place) { holders_.erase(place); }

private:
    std::list<Holder> holders_;  ///< In the order in which their clients began to be waited for.
};

}  // namespace a351::daemon::page
