#pragma once
/// @file
/// Seats for the connections of the page, so that no client can take them all.
///
/// A connection gets a seat when it is accepted and leaves it when it ends.  If all seats are taken,
/// a newer connection takes the seat of one whose client is slow with a request or with reading the
/// answer, but not that of a live stream.

#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace a351::daemon::page {

/// The seats and their holders.  One thread at a time.
class Seats {
public:
    static constexpr std::size_t kMost = 32;         ///< Bounds the cost of a client that leaks.
    static constexpr std::size_t kMostStreams = 20;  ///< Part of the seats; 12 are for requests.
    static constexpr std::size_t kForLoopback = 2;   ///< Part of both that others cannot take.
    /// Seats of another computer's address.  A browser takes six, and one more for each page.
    static constexpr std::size_t kOfOneAddress = 12;

    struct Holder {
        std::string address;  ///< Address of the client.
        bool is_loopback = false;
        std::function<void()> leave;  ///< Closes the connection; it is called at most once.
        bool is_streaming = false;    ///< A live stream, which is not replaced.
        bool is_leaving = false;      ///< The seat was given to another connection.
    };
    using Place = std::list<Holder>::iterator;

    /// Seats a connection.  If all seats are taken, the holder leaves whose client has been waited
    /// for longest.
    /// @return end() if nobody can leave, or if the address has all its seats.
    [[nodiscard]] Place seat(Holder holder);
    [[nodiscard]] Place end() { return holders_.end(); }

    /// Notes that a holder gets its answer: from now on it is waited for.
    void answered(Place place) { holders_.splice(holders_.end(), holders_, place); }

    /// Makes a holder a live stream.
    /// @return false if there are too many.
    [[nodiscard]] bool begin_stream(Place place);

    void leave(Place place) { holders_.erase(place); }

private:
    std::list<Holder> holders_;  ///< In the order in which their clients began to be waited for.
};

}  // namespace a351::daemon::page
