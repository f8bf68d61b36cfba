#include "protocol/wire/device_profile.hpp"

#include <map>
#include <string>
#include "tests/support/catch.hpp"

namespace a351::wire {
namespace {

using Names = std::vector<std::string_view>;

}  // namespace

TEST_CASE("profiles are found by name, and only the documented one is verified") {
    CHECK(profile_names() == std::vector<std::string>{"A351", "A352AD10", "A370AD10"});
    CHECK_FALSE(find_profile("A370AD10")->is_verified);
    const DeviceProfile* documented = find_profile("A352AD10");
    const DeviceProfile* copy = find_profile("A351");
    REQUIRE(documented != nullptr);
    REQUIRE(copy != nullptr);
    CHECK(documented->is_verified);
    CHECK_FALSE(copy->is_verified);
    CHECK(copy->product_id_prefix == "A351");
    CHECK(find_profile("a351") == nullptr);
    CHECK(find_profile("") == nullptr);
}

TEST_CASE("scales are those of the data sheet, and the unverified profile has the same") {
    const DeviceProfile& documented = *find_profile("A352AD10");
    const DeviceProfile& copy = *find_profile("A351");
    CHECK(documented.acceleration(1).value() == 5.9604644775390625e-8);  // 2^-24, table 2.3
    CHECK(documented.acceleration(1 << 24).value() == 1.0);
    CHECK(to_milligal(documented.acceleration(1)).value() ==
          Approx(0.05845218896865844).epsilon(1e-15));
    // Data sheet 7.6: 2634 counts at 25 degC.
    CHECK(documented.temperature(2634).value() == Approx(25.0).margin(0.0019));  // half a count
    CHECK(documented.temperature(-1981).value() == Approx(42.4986).margin(5e-5));
    CHECK(documented.temperature_counts(DegC(42.4986)) == -1981);
    for (const std::int32_t counts : {-2147483647 - 1, -1, 0, 1, 16713252, 2147483647}) {
        CHECK(copy.acceleration(counts) == documented.acceleration(counts));
        CHECK(copy.temperature(counts) == documented.temperature(counts));
    }
    CHECK(copy.rated_range == StandardGravity(15.0));
    CHECK(copy.noise_ug_per_sqrt_hz == 0.2);
}

TEST_CASE("the A370 differs from the A352 as its brief sheet says") {
    const DeviceProfile& profile = *find_profile("A370AD10");
    CHECK(profile.product_id_prefix == "A370AD10");
    CHECK(profile.acceleration(1 << 24).value() == 1.0);
    CHECK(profile.rated_range == StandardGravity(10.0));
    CHECK(profile.noise_ug_per_sqrt_hz == 0.02);
    CHECK(profile.temperature(2634).value() == Approx(25.0).margin(0.0019));  // half a count
    CHECK(profile.temperature_counts(DegC(1e6)) == -32768);                   // 16 bits
    CHECK(profile.temperature_counts(DegC(-1e6)) == 32767);
    CHECK(profile.start_up == std::chrono::milliseconds(1100));
}

TEST_CASE("COUNT steps and group delays are those of the data sheet") {
    const DeviceProfile& profile = *find_profile("A352AD10");
    const std::map<int, int> steps{{1000, 4}, {500, 8}, {200, 20}, {100, 40}, {50, 80}};  // 7.5
    REQUIRE(profile.output_rates_hz.size() == steps.size());
    for (const auto& [rate_hz, step] : steps) CHECK(profile.count_step(rate_hz) == step);
    const std::map<int, int> delays_us{{64, 7'875}, {128, 15'875}, {512, 63'875}};  // table 5.3
    for (const FilterSpec& filter : profile.filters) {
        if (filter.is_user) continue;
        CHECK(profile.group_delay(filter) ==
              Nanoseconds(std::chrono::microseconds(delays_us.at(filter.taps))));
    }
}

TEST_CASE("the filters allowed at each rate are those of the data sheet") {
    const DeviceProfile& profile = *find_profile("A351");  // table 5.4
    CHECK(profile.filters_allowed_at(50) == Names{"k512_fc9"});
    CHECK(profile.filters_allowed_at(100) == Names{"k512_fc9", "k512_fc16"});
    CHECK(profile.filters_allowed_at(200) ==
          Names{"k128_fc36", "k512_fc9", "k512_fc16", "k512_fc60"});
    CHECK(profile.filters_allowed_at(500) == Names{"k64_fc83", "k128_fc36", "k128_fc110",
                                                   "k512_fc9", "k512_fc16", "k512_fc60",
                                                   "k512_fc210"});
    CHECK(profile.filters_allowed_at(1000) ==
          Names{"k64_fc83", "k64_fc220", "k128_fc36", "k128_fc110", "k128_fc350", "k512_fc9",
                "k512_fc16", "k512_fc60", "k512_fc210", "k512_fc460"});
    CHECK(profile.filters_allowed_at(60).empty());
}

TEST_CASE("filters are found by name and by code") {
    const DeviceProfile& profile = *find_profile("A352AD10");
    REQUIRE(profile.filters.size() == 14);
    for (const FilterSpec& filter : profile.filters) {
        CHECK(profile.filter_named(filter.name) == &filter);
        CHECK(profile.filter_coded(filter.code) == &filter);
        if (!filter.name.starts_with("k")) continue;
        CHECK(filter.name.substr(1).starts_with(std::to_string(filter.taps).append("_fc")));
    }
    CHECK(profile.filter_named("k512_fc9")->code == 6);
    CHECK(profile.filter_coded(0xE)->taps == 512);
    CHECK(profile.filter_coded(0) == nullptr);
    CHECK(profile.filter_coded(0xF) == nullptr);
    CHECK(profile.filter_named("k512_fc10") == nullptr);
}

}  // namespace a351::wire
