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
        return seats.seat({.host = host_of(boost::asio::ip::make_address(address)),
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
        place->is_streaming = true;  // Never makes room.
    }
    CHECK(room.take("192.0.2.99") == room.seats.end());
    CHECK(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.take("127.0.0.1") != room.seats.end());
    CHECK(room.left.empty());
}

TEST_CASE("another host takes at most 16 seats, and its own oldest connection makes room",
          "[daemon][page]") {
    Room room;
    const auto first = room.take("192.0.2.1");
    for (int i = 1; i < 16; ++i) static_cast<void>(room.take("192.0.2.1"));
    CHECK(room.take("192.0.2.2") != room.seats.end());
    CHECK(room.take("192.0.2.1") != room.seats.end());
    CHECK(room.left == std::vector<std::string>{"192.0.2.1"});
    CHECK(first->is_leaving);
    room.seats.leave(first);
}

TEST_CASE("global IPv6 addresses of one subnet share the seats of a host", "[daemon][page]") {
    CHECK(host_of(boost::asio::ip::make_address("2001:db8:1:2:3:4:5:6")) == "2001:db8:1:2::");
    CHECK(host_of(boost::asio::ip::make_address("::1")) == "::1");
    CHECK(host_of(boost::asio::ip::make_address("::ffff:192.0.2.1")) == "::ffff:192.0.2.1");
    Room room;
    for (int i = 0; i < 17; ++i)
        static_cast<void>(room.take("2001:db8:1:2::" + std::to_string(i + 1)));
    CHECK(room.left == std::vector<std::string>{"2001:db8:1:2::1"});
    CHECK(room.take("2001:db8:1:3::1") != room.seats.end());
    CHECK(room.left.size() == 1);
}

TEST_CASE("private and link-local IPv6 addresses of one subnet have seats of their own",
          "[daemon][page]") {
    for (const char* prefix : {"fe80::", "fd00:1:2:3::", "fc00::"}) {
        Room room;
        for (int i = 0; i < 18; ++i)
            REQUIRE(room.seats.begin_stream(room.take(prefix + std::to_string(i + 1))));
        CHECK(room.left.empty());
    }
}

TEST_CASE("the client that is waited for longest makes room, and a stream never",
          "[daemon][page]") {
    Room room;
    std::vector<Seats::Place> places;
    for (int i = 0; i < 30; ++i) places.push_back(room.take("192.0.2." + std::to_string(i)));
    REQUIRE(room.seats.begin_stream(places[0]));
    room.seats.answered(places[1]);  // waited for since now
    CHECK(room.take("198.51.100.1") != room.seats.end());
    CHECK(room.left == std::vector<std::string>{"192.0.2.2"});
    for (std::size_t i = 3; i < 30; ++i) places[i]->is_streaming = true;
    CHECK(room.take("198.51.100.2") != room.seats.end());
    CHECK(room.left.back() == "192.0.2.1");
}

TEST_CASE("another host has at most 8 streams, and two are kept for loopback", "[daemon][page]") {
    Room room;
    for (int i = 0; i < 8; ++i)
        REQUIRE(room.seats.begin_stream(room.take("2001:db8::" + std::to_string(i + 1))));
    const auto ninth = room.take("2001:db8::9");
    CHECK_FALSE(room.seats.begin_stream(ninth));
    CHECK_FALSE(ninth->is_streaming);
    for (int i = 0; i < 10; ++i)
        REQUIRE(room.seats.begin_stream(room.take("192.0.2." + std::to_string(i))));
    CHECK_FALSE(room.seats.begin_stream(room.take("192.0.2.99")));
    CHECK(room.seats.begin_stream(room.take("127.0.0.1")));
    CHECK(room.seats.begin_stream(room.take("127.0.0.1")));
    CHECK_FALSE(room.seats.begin_stream(room.take("127.0.0.1")));
}
