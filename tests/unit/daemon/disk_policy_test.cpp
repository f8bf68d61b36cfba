#include "daemon/store/disk_policy.hpp"

#include "daemon/store/archive_thread.hpp"
#include "daemon/store/journal_thread.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::store;
using a351::daemon::status::Status;

TEST_CASE("below 1 GiB of free space, or if it is unknown, the status warns", "[daemon][disk]") {
    const auto reported = [](std::optional<std::uint64_t> free_bytes) {
        Status status;
        status.disk_free_bytes = free_bytes;
        report({}, {}, {}, false, status);
        return status;
    };
    constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
    CHECK(reported(kGiB).level == Status::Level::good);
    CHECK(reported(kGiB - 1).level == Status::Level::warning);
    CHECK(reported({}).reasons ==
          std::vector<text::Message>{"disk: the free space cannot be determined; check the disk of "
                                     "storage.root"});
}
