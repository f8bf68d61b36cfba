#include "daemon/page/live_message.hpp"

#include <cstring>
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/live_records.hpp"

using namespace a351::daemon;
using namespace a351;
using namespace a351::daemon::live;
using namespace a351::daemon::page;

TEST_CASE("a block of samples is encoded as the format says, byte for byte") {
    live::Block block;
    block.first_index = 0x0102030405060708;
    block.first_time = *parse_rfc3339("1970-01-01T00:00:01.5Z");
    block.interval_s = 0.02;
    block.counts = {{{1, 2}, {-1, 0}, {7, 8}, {0x01020304, -2}}};
    const auto bytes = encoded(block);
    // Doubles: 1500 ms and 20 ms, IEEE 754.
    const unsigned char expected[] = {
        1,    1,    0x0F, 0,    2,    0,    0,    0,      // version, kind, mask, count
        8,    7,    6,    5,    4,    3,    2,    1,      // index
        0,    0,    0,    0,    0,    0x70, 0x97, 0x40,   // time
        0,    0,    0,    0,    0,    0,    0x34, 0x40,   // interval
        1,    0,    0,    0,    2,    0,    0,    0,      // x
        0xFF, 0xFF, 0xFF, 0xFF, 0,    0,    0,    0,      // y
        7,    0,    0,    0,    8,    0,    0,    0,      // z
        4,    3,    2,    1,    0xFE, 0xFF, 0xFF, 0xFF};  // temperature
    REQUIRE(bytes.size() == sizeof expected);
    CHECK(std::memcmp(bytes.data(), expected, sizeof expected) == 0);
}

TEST_CASE("a message with the largest number of samples just fits the size limit") {
    live::Block block;
    for (auto& channel : block.counts) channel.resize(kMostSamplesPerMessage);
    const auto size = encoded(block).size();
    CHECK(size <= 64 * 1024);
    CHECK(size + kLiveChannelCount * sizeof(std::int32_t) > 64 * 1024);
}

TEST_CASE("each viewer has its own position, and all viewers read the same bytes") {
    LiveMessages messages;
    std::uint64_t one = messages.end(), other = one, missed = 0;
    CHECK_FALSE(messages.next(one, missed));
    messages.push({.bytes = "a"});
    messages.push({.is_text = true, .bytes = "b"});
    const auto first = messages.next(one, missed);
    REQUIRE(first);
    CHECK(first->bytes == "a");
    CHECK(messages.next(one, missed)->is_text);
    CHECK_FALSE(messages.next(one, missed));
    CHECK(messages.next(other, missed) == first);
    CHECK(missed == 0);
}

TEST_CASE("a viewer that reads too slowly misses messages, which are counted") {
    LiveMessages messages;
    std::uint64_t position = messages.end(), missed = 0;
    for (int i = 0; i < 1000; ++i) messages.push({.bytes = std::to_string(i)});
    CHECK(messages.next(position, missed)->bytes == std::to_string(1000 - kMostMessagesKept));
    CHECK(missed == 1000 - kMostMessagesKept);
    CHECK(messages.next(position, missed)->bytes == std::to_string(1001 - kMostMessagesKept));
    CHECK(missed == 1000 - kMostMessagesKept);
}

TEST_CASE("fewer messages are kept if they are large, but always the newest") {
    LiveMessages messages;
    std::uint64_t position = messages.end(), missed = 0;
    for (int i = 0; i < 100; ++i) messages.push({.bytes = std::string(kLargestLiveMessage, 'x')});
    std::size_t kept = 0;
    while (const auto message = messages.next(position, missed)) kept += message->bytes.size();
    CHECK(kept == kMostBytesKept);
    messages.push({.bytes = std::string(2 * kMostBytesKept, 'x')});
    CHECK(messages.next(position, missed)->bytes.size() == 2 * kMostBytesKept);
}
