/// @file
/// The reader thread must not allocate while it samples, because an allocator may wait for a lock
/// that a less urgent thread holds.  A separate program, because it replaces operator new.

#include <filesystem>
#include <set>
#include "daemon/source/sensor_link.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/counted_allocations.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"

namespace {

std::set<pid_t> threads() {
    std::set<pid_t> ids;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
        ids.insert(static_cast<pid_t>(std::stoi(entry.path().filename())));
    return ids;
}

}  // namespace

using namespace a351;
using namespace a351::daemon::source;

TEST_CASE("the reader thread allocates no memory while it samples") {
    FakeSensor sensor;
    LinkOptions options;
    options.address.path = sensor.path();
    options.profile = wire::find_profile("A351");
    options.header.profile = "A351";
    ReadQueue queue;
    const HostClock clock;
    SensorLink link(options, clock, queue);

    const auto before = threads();
    link.start();
    auto after = threads();
    for (const pid_t id : before) after.erase(id);
    REQUIRE(after.size() == 1);

    test::watched_thread = *after.begin();
    REQUIRE(eventually([&] { return sensor.frames_sent >= 20; }));
    CHECK(test::allocations > 0);  // Configuring the sensor allocates, so this is the right thread.
    test::allocations = 0;
    const auto sent = sensor.frames_sent.load();
    REQUIRE(eventually([&] { return sensor.frames_sent >= sent + 150; }));
    CHECK(test::allocations == 0);
    CHECK(link.status().state == LinkStatus::State::sampling);
    test::watched_thread = 0;
    std::size_t frames_read = 0;
    for (auto item = queue.front(); item; item = queue.front()) {
        if (item->kind == ReadQueue::Kind::session) static_cast<void>(queue.take_session());
        frames_read += item->kind == ReadQueue::Kind::rx ? item->bytes.size() / 24 : 0;
        queue.pop();
    }
    CHECK(frames_read >= 150);
    link.stop();
}
