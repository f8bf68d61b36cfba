#include "daemon/source/read_queue.hpp"

#include <random>
#include <thread>
#include <vector>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::source;

namespace {

constexpr std::size_t kSmall = 16384;

RawTime at(std::int64_t ns) { return RawTime(Nanoseconds(ns)); }

}  // namespace

TEST_CASE("items pushed in one thread come out in another, in order and unchanged") {
    ReadQueue queue(kSmall);
    constexpr std::int64_t kItems = 20000;
    std::thread producer([&queue] {
        std::mt19937 random(1);
        for (std::int64_t i = 0; i < kItems; ++i) {
            const std::vector<std::byte> bytes(random() % ReadQueue::kLargestItem,
                                               static_cast<std::byte>(i));
            while (!queue.push(ReadQueue::Kind::rx, at(i), bytes)) std::this_thread::yield();
        }
    });
    std::mt19937 random(1);
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < kItems; ++i) {
        auto item = queue.front();
        for (; !item; item = queue.front()) std::this_thread::yield();
        const std::vector<std::byte> expected(random() % ReadQueue::kLargestItem,
                                              static_cast<std::byte>(i));
        const bool is_right =
            item->kind == ReadQueue::Kind::rx && item->time == at(i) &&
            std::equal(item->bytes.begin(), item->bytes.end(), expected.begin(), expected.end());
        if (!is_right) ++wrong;
        queue.pop();
    }
    producer.join();
    CHECK(wrong == 0);
    CHECK(queue.fill() == 0);
}

TEST_CASE("a full queue refuses new items and keeps the old ones") {
    ReadQueue queue(kSmall);
    const std::vector<std::byte> bytes(1000, std::byte{7});
    std::int64_t taken = 0;
    while (queue.push(ReadQueue::Kind::rx, at(taken), bytes)) ++taken;
    CHECK(taken >= 15);
    for (std::int64_t i = 0; i < taken; ++i) {
        REQUIRE(queue.front());
        CHECK(queue.front()->time == at(i));
        CHECK(queue.front()->bytes.size() == bytes.size());
        queue.pop();
    }
    CHECK_FALSE(queue.front());
}

TEST_CASE("the queue holds an hour of reads at 50 Hz") {
    ReadQueue queue;
    const std::vector<std::byte> frame(24);
    std::int64_t refused = 0;
    for (std::int64_t i = 0; i < 180000; ++i) {
        if (!queue.push(ReadQueue::Kind::rx, at(i), frame)) ++refused;
    }
    CHECK(refused == 0);
}

TEST_CASE("a session header comes out between the bytes pushed before and after it") {
    ReadQueue queue(kSmall);
    const std::vector<std::byte> bytes(5);
    REQUIRE(queue.push(ReadQueue::Kind::rx, at(1), bytes));
    journal::Header header;
    header.serial_number = "00000042";
    REQUIRE(queue.push_session(header, at(2)));
    REQUIRE(queue.push(ReadQueue::Kind::tx, at(3), bytes));
    queue.pop();
    REQUIRE(queue.front());
    CHECK(queue.front()->kind == ReadQueue::Kind::session);
    CHECK(queue.take_session().serial_number == "00000042");
    queue.pop();
    REQUIRE(queue.front());
    CHECK(queue.front()->kind == ReadQueue::Kind::tx);
}
