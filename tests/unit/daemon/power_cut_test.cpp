#include <algorithm>
#include <functional>

#include "tests/unit/daemon/store_rig.hpp"
#include "tests/unit/files/forgetful_files.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::store;

TEST_CASE_METHOD(Rig, "after a power cut every journaled sample is archived once") {
    constexpr int kCuts = 100;
    test::ForgetfulFiles forgetful;
    std::mt19937_64 random(11);
    Store store(forgetful, options(), clock, reads);
    store.start();
    begin_session();
    std::size_t lost = 0, repaired = 0, torn = 0, holes = 0;
    // Time at which each sample was fed.
    std::vector<std::chrono::steady_clock::time_point> fed_at;
    std::chrono::duration<double> oldest_lost{0};
    for (int cut = 0; cut < kCuts; ++cut) {
        feed(static_cast<int>(random() % 1000));
        fed_at.resize(static_cast<std::size_t>(fed), std::chrono::steady_clock::now());
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 40));
        const auto found = directory.path() / ("found-" + std::to_string(cut));
        const auto journaled = status_of(store).journaled;
        const auto cut_at = std::chrono::steady_clock::now();
        forgetful.cut(root, found, random);
        store::Options again = options();
        again.root = found;
        const auto report = recover(files::posix_files(), again, clock);
        repaired += report.archive.size();
        torn += report.journal ? 1U : 0U;
        INFO("cut " << cut << ", journaled " << journaled.value_or(-1) << ", added "
                    << report.records_added);
        const auto counts = archived_counts(found, "BNZ");
        const auto expected = expected_counts(fed);
        REQUIRE(std::ranges::adjacent_find(counts, std::greater_equal()) == counts.end());
        REQUIRE(std::ranges::includes(expected, counts));
        REQUIRE(samples_in_records(found, "BNZ") == counts.size());
        // The disk may keep chunks behind others that it lost.
        const auto first_lost =
            static_cast<std::size_t>(std::ranges::mismatch(counts, expected).in1 - counts.begin());
        REQUIRE(static_cast<std::int64_t>(first_lost) > journaled.value_or(-1));
        holes += first_lost < counts.size() ? 1U : 0U;
        lost += static_cast<std::size_t>(fed) - counts.size();
        if (first_lost < fed_at.size())
            oldest_lost =
                std::max<std::chrono::duration<double>>(oldest_lost, cut_at - fed_at[first_lost]);
        CHECK(recover(files::posix_files(), again, clock).records_added == 0);
        std::filesystem::remove_all(found);
    }
    std::printf(
        "power cuts: %d; samples fed that were not journaled yet and lost: %zu, the oldest fed "
        "%.2f s before its cut; journals torn: %zu, with holes: %zu, day files repaired: %zu\n",
        kCuts, lost, oldest_lost.count(), torn, holes, repaired);
    CHECK(repaired > 0);
    CHECK(torn > 0);
    CHECK(store.stop());
}
