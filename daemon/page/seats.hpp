#pragma once
/// @file
/// Seats for the connections of the page, so that no client can take them all.
///
/// A connection gets a seat when it is accepted and leaves it when it ends.  While its request is
/// not complete, a newer connection may take the seat.

#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace a351::daemon::page {

/// The seats and their holders.  One thread at a time.
class Seats {
public:
    static constexpr std::size_t kMost = 32;          ///< Bounds the cost of a client that leaks.
    static constexpr std::size_t kOfOneAddress = 16;  ///< One other host; a browser takes six.
    static constexpr std::size_t kForLoopback = 2;    ///< Seats of no other host: a351ctl and page.

    struct Holder {
        std::string address;
        bool is_loopback = false;
        std::function<void()> leave;  ///< Closes the connection; it is called at most once.
        bool is_waiting = true;       ///< No complete request has arrived that is not answered.
        bool is_leaving = false;      ///< The seat was given to another connection.
    };
    using Place = std::list<Holder>::iterator;

    /// Seats a connection.  If there is no seat for it, the holder that has waited longest for its
    /// request leaves: of the same address, if that one has all its seats; else of any.
    /// @return end() if nobody can leave.
    [[nodiscard]] Place seat(Holder holder);
    [[nodiscard]] Place end() { return holders_.end(); }

    /// Notes that the request of a holder is complete.
    static void request_came(Place place) { place->is_waiting = false; }

    /// Notes that a holder was answered and waits for its next request.
    void was_answered(Place place);

    void leave(Place place) { holders_.erase(place); }

private:
    std::list<Holder> holders_;  ///< In the order in which they began to wait.
};

}  // namespace a351::daemon::page
