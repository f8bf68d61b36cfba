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

TEST_CASE("two of 32 seats and two of 20 streams are kept for loopback") {
    const int of_loopback = GENERATE(0, 2);  // Clients that came before all others.
    Room room;
    for (int i = 0; i < of_loopback; ++i) CHECK(room.seats.begin_stream(room.take("127.0.0.1")));
    std::vector<Seats::Place> places;
    for (int i = 0; i < 30; ++i) places.push_back(room.take("192.0.2." + std::to_string(i)));
    for (std::size_t i = 0; i < 18; ++i) CHECK(room.seats.begin_stream(places[i]));
    CHECK_FALSE(room.seats.begin_stream(places[18]));
    CHECK_FALSE(places[18]->is_streaming);
    CHECK(room.left.empty());
    for (const auto& place : places) place->is_streaming = true;  // Never makes room.
    CHECK(room.take("192.0.2.99") == room.seats.end());
    for (std::size_t i = 18; i < places.size(); ++i) places[i]->is_streaming = false;
    for (int i = of_loopback; i < 2; ++i) {
        const Seats::Place kept = room.take("127.0.0.1");
        REQUIRE(kept != room.seats.end());
        CHECK(room.seats.begin_stream(kept));
    }
    CHECK(room.left.empty());
}

TEST_CASE("loopback begins no 21st stream") {
    Room room;
    for (int i = 0; i < 20; ++i) REQUIRE(room.seats.begin_stream(room.take("127.0.0.1")));
    CHECK_FALSE(room.seats.begin_stream(room.take("127.0.0.1")));
}

TEST_CASE("one address takes at most 12 seats, and loopback all that are free") {
    Room room;
    std::vector<Seats::Place> places;
    for (int i = 0; i < 12; ++i) places.push_back(room.take("192.0.2.1"));
    CHECK(room.take("192.0.2.1") == room.seats.end());
    CHECK(room.take("192.0.2.2") != room.seats.end());
    room.seats.leave(places.front());
    CHECK(room.take("192.0.2.1") != room.seats.end());
    for (int i = 0; i < 19; ++i) REQUIRE(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.left.empty());
}

TEST_CASE("the client that is waited for longest makes room, and a stream never") {
    Room room;
    std::vector<Seats::Place> places;
    for (int i = 0; i < 30; ++i) places.push_back(room.take("192.0.2." + std::to_string(i)));
    REQUIRE(room.seats.begin_stream(places[0]));
    room.seats.answered(places[1]);  // waited for since now
    CHECK(room.take("198.51.100.1") != room.seats.end());
    CHECK(room.left == std::vector<std::string>{"192.0.2.2"});
    CHECK(places[2]->is_leaving);
    for (std::size_t i = 3; i < 30; ++i) places[i]->is_streaming = true;
    CHECK(room.take("198.51.100.2") != room.seats.end());
    CHECK(room.left.back() == "192.0.2.1");
}

TEST_CASE("a client of loopback makes room only for loopback") {
    Room room;
    for (int i = 0; i < 32; ++i) static_cast<void>(room.take("127.0.0.1"));
    CHECK(room.take("192.0.2.1") == room.seats.end());
    CHECK(room.left.empty());
    CHECK(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.left.size() == 1);
}
