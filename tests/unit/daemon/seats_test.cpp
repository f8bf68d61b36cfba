#include "daemon/page/seats.hpp"

#include <vector>
#include "tests/support/catch.hpp"

using namespace a351::daemon::page;

namespace {

/// Seats, and the addresses of those who had to leave.
struct Room {
    Seats seats;
    std::vector<std::string> left;

    Seats::Place take(const std::string& address) {
        return seats.seat({.address = address,
                           .is_loopback = address == "127.0.0.1",
                           .leave = [this, address] { left.push_back(address); }});
    }
};

}  // namespace

TEST_CASE("two seats are kept for loopback", "[daemon][page]") {
    Room room;
    for (int i = 0; i < 30; ++i) {
        const auto place = room.take("192.0.2." + std::to_string(i));
        REQUIRE(place != room.seats.end());
        Seats::request_came(place);
    }
    CHECK(room.take("192.0.2.99") == room.seats.end());
    CHECK(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.left.empty());
}

TEST_CASE("another host takes at most 16 seats, and its own oldest request makes room",
          "[daemon][page]") {
    Room room;
    const auto first = room.take("192.0.2.1");
    for (int i = 1; i < 16; ++i) Seats::request_came(room.take("192.0.2.1"));
    CHECK(room.take("192.0.2.2") != room.seats.end());
    CHECK(room.take("192.0.2.1") != room.seats.end());
    CHECK(room.left == std::vector<std::string>{"192.0.2.1"});
    CHECK(first->is_leaving);
    room.seats.leave(first);
}

TEST_CASE("the request that has waited longest makes room, and a running one never",
          "[daemon][page]") {
    Room room;
    std::vector<Seats::Place> places;
    for (int i = 0; i < 30; ++i) places.push_back(room.take("192.0.2." + std::to_string(i)));
    Seats::request_came(places[0]);
    Seats::request_came(places[1]);
    room.seats.was_answered(places[1]);  // waits since now
    CHECK(room.take("198.51.100.1") != room.seats.end());
    CHECK(room.left == std::vector<std::string>{"192.0.2.2"});
    for (std::size_t i = 3; i < 30; ++i) Seats::request_came(places[i]);
    CHECK(room.take("198.51.100.2") != room.seats.end());
    CHECK(room.left.back() == "192.0.2.1");
}
