#include "corrector/archive_series/wrong_profile.hpp"

#include <algorithm>
#include "tests/support/catch.hpp"

#include "protocol/wire/shipped_profiles.hpp"
#include "tests/unit/archive/data_root.hpp"

using namespace a351;
using namespace a351::corrector::archive_series;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

/// Writes the journal of a box at 1 g and 42.5 degC for two minutes.  Before sample `still` its axes
/// are dead, and the line loses the first `lost` of each 50 samples.  The host pauses for `pause` at
/// the beginning.
void record(const archive::DataRoot& root, std::int64_t still = 0, std::int64_t lost = 0,
            std::int64_t samples = 6000, Nanoseconds pause = {}) {
    JournalStream stream;
    for (std::int64_t k = 0; k < samples; ++k) {
        if (k % 50 < lost) continue;
        wire::BurstValues values = values_of(k);
        values.temperature = -1981;
        if (k < still) values.axes = {};
        stream.bytes(frame_of(values), std::max(due(k), due(0) + pause));
        if (k % 50 == 49) stream.second(due(k));
    }
    root.write_journal(stream.chunks);
}

using Changes = std::vector<std::pair<std::string, std::string>>;

/// Returns the profile of the M-A352AD10 with texts of its file replaced.
const wire::DeviceProfile& changed(const Changes& changes) {
    const test::TemporaryDirectory folder;
    std::string toml(
        std::ranges::find(wire::shipped_profiles(), "A352AD10", &wire::ShippedProfile::name)->toml);
    for (const auto& [right, wrong] : changes) toml.replace(toml.find(right), right.size(), wrong);
    return wire::load_profile(folder.write("changed.toml", toml));
}

}  // namespace

TEST_CASE("a profile with which no sensor can have recorded a journal is refused") {
    const archive::DataRoot root;
    record(root);
    const auto refused = [&](const Changes& changes, const std::string& value) {
        CHECK_THROWS_WITH(
            refuse_wrong_profile(root.path(), changed(changes)),
            ContainsSubstring(value) && ContainsSubstring("a351d --config FILE --identify"));
    };
    refused({{"fraction_bits = 24", "fraction_bits = 23"}}, "reads 2.00 g");
    refused({{"fraction_bits = 24", "fraction_bits = 25"}}, "reads 0.50 g");
    refused({{"offset_degc = 34.987", "offset_degc = 135"}}, "reads 142.5 degC");
    refused({{"tick_hz = 4000", "tick_hz = 2000"}}, "2 times the samples");
    refused({{"tick_hz = 4000", "tick_hz = 8000"}}, "0.5 times the samples");
    refused({{"code = 5 },\n    { hz = 50", "code = 6 },\n    { hz = 50"},
             {"hz = 50, code = 6", "hz = 50, code = 5"}},
            "0 % of the samples follow");
}

TEST_CASE(
    "a right profile is not refused, although the axes were dead for a time or the line lost "
    "much, and another product is named") {
    const archive::DataRoot root, carried, lossy;
    record(root);
    record(carried, 2400);
    CHECK(refuse_wrong_profile(root.path(), *wire::find_profile("A352AD10")).empty());
    CHECK(refuse_wrong_profile(carried.path(), *wire::find_profile("A352AD10")).empty());
    const archive::DataRoot brief;
    record(brief, 0, 0, 600, 1400ms);  // 1.04 times the samples in the only ten seconds
    CHECK(refuse_wrong_profile(brief.path(), *wire::find_profile("A352AD10")).empty());
    record(lossy, 0, 30);
    CHECK(refuse_wrong_profile(lossy.path(), *wire::find_profile("A352AD10")).empty());
    CHECK_THAT(refuse_wrong_profile(root.path(), *wire::find_profile("A370AD10")),
               ContainsSubstring("product A352AD10, profile A370AD10 is for A370AD10"));
}
