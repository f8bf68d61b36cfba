#include "daemon/store/assess.hpp"

#include <catch2/catch.hpp>

using namespace a351;
using namespace a351::daemon;

namespace {

Status healthy() {
    Status status;
    status.timing_state = timing::TimingState::locked;
    status.disk_free_bytes = std::uint64_t{100} << 30;
    return status;
}

}  // namespace

TEST_CASE("a sampling link with time and space is good", "[daemon][assess]") {
    Status status = healthy();
    LinkStatus link;
    link.state = LinkStatus::State::sampling;
    link.device = wire::DeviceIdentity{"A351AU10", "00000042", 1, 0, true};
    fill(status, link);
    assess(status);
    CHECK(status.level == Status::Level::good);
    CHECK(status.reasons.empty());
    CHECK(status.serial_number == "00000042");
}

TEST_CASE("each trouble raises the level and is named", "[daemon][assess]") {
    Status status = healthy();
    LinkStatus link;
    link.state = LinkStatus::State::searching;
    link.trouble = "/dev/x: not plugged in";
    fill(status, link);
    CHECK(status.level == Status::Level::fault);
    CHECK(status.reasons == std::vector<std::string>{"no data: /dev/x: not plugged in"});

    status = healthy();
    status.timing_state = timing::TimingState::unlocked;
    assess(status);
    CHECK(status.level == Status::Level::warning);

    status = healthy();
    status.disk_free_bytes = 1000;
    assess(status);
    CHECK(status.level == Status::Level::warning);

    status = healthy();
    status.disk_free_bytes.reset();
    assess(status);
    CHECK(status.reasons == std::vector<std::string>{"free space of the record cannot be told"});

    status = healthy();
    link.state = LinkStatus::State::sampling;
    link.is_held_up = true;
    fill(status, link);
    CHECK(status.level == Status::Level::warning);
}
