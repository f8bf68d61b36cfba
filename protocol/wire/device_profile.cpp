#include "protocol/wire/device_profile.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace a351::wire {
namespace {

// Output rates at which a filter may be used: data sheet table 5.4, "recommended" and "restricted".
constexpr std::array kRatesFrom50{50, 100, 200, 500, 1000};
constexpr auto kRatesFrom100 = std::span(kRatesFrom50).subspan(1);
constexpr auto kRatesFrom200 = std::span(kRatesFrom50).subspan(2);
constexpr auto kRatesFrom500 = std::span(kRatesFrom50).subspan(3);
constexpr auto kRates1000 = std::span(kRatesFrom50).subspan(4);

// Data sheet tables 5.3 and 5.4, 7.12.  User filters are allowed at every rate: their author is
// responsible for the stop band.
constexpr std::array kFilters{
    FilterSpec{0x1, "k64_fc83", 64, kRatesFrom500},
    FilterSpec{0x2, "k64_fc220", 64, kRates1000},
    FilterSpec{0x3, "k128_fc36", 128, kRatesFrom200},
    FilterSpec{0x4, "k128_fc110", 128, kRatesFrom500},
    FilterSpec{0x5, "k128_fc350", 128, kRates1000},
    FilterSpec{0x6, "k512_fc9", 512, kRatesFrom50},
    FilterSpec{0x7, "k512_fc16", 512, kRatesFrom100},
    FilterSpec{0x8, "k512_fc60", 512, kRatesFrom200},
    FilterSpec{0x9, "k512_fc210", 512, kRatesFrom500},
    FilterSpec{0xA, "k512_fc460", 512, kRates1000},
    FilterSpec{0xB, "user4", 4, kRatesFrom50},
    FilterSpec{0xC, "user64", 64, kRatesFrom50},
    FilterSpec{0xD, "user128", 128, kRatesFrom50},
    FilterSpec{0xE, "user512", 512, kRatesFrom50},
};
constexpr std::uint8_t kLastBuiltInFilter = 0xA;

constexpr std::array kOutputRates{Coded{1000, 2}, Coded{500, 3}, Coded{200, 4}, Coded{100, 5},
                                  Coded{50, 6}};                                        // 7.11
constexpr std::array kBaudRates{Coded{460800, 1}, Coded{230400, 2}, Coded{115200, 3}};  // 7.13

constexpr DeviceProfile kA352{
    .name = "A352AD10",
    .product_id_prefix = "A352AD10",
    .is_verified = true,
    .acceleration_fraction_bits = 24,      // table 2.3, 7.7
    .tilt_fraction_bits = 29,              // table 2.3, 7.8
    .temperature_slope_degc = -0.0037918,  // 7.6
    .temperature_offset_degc = 34.987,
    .internal_rate_hz = 4000,                            // 5.17
    .data_ready_delay = std::chrono::microseconds(430),  // functional times, maximum
    .rated_range = StandardGravity(15.0),
    .output_rates_hz = kOutputRates,
    .baud_rates = kBaudRates,
    .filters = kFilters,
};

constexpr DeviceProfile unverified_copy(DeviceProfile profile, std::string_view name) {
    profile.name = name;
    profile.product_id_prefix = name;
    profile.is_verified = false;
    return profile;
}

constexpr std::array kProfiles{unverified_copy(kA352, "A351"), kA352};

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

StandardGravity DeviceProfile::acceleration(std::int32_t counts) const noexcept {
    return StandardGravity(std::ldexp(static_cast<double>(counts), -acceleration_fraction_bits));
}

DegC DeviceProfile::temperature(std::int32_t counts) const noexcept {
    return DegC(temperature_slope_degc * static_cast<double>(counts) + temperature_offset_degc);
}

std::uint16_t DeviceProfile::count_step(int output_rate_hz) const noexcept {
    assert(output_rate_hz > 0 && internal_rate_hz % output_rate_hz == 0);
    return static_cast<std::uint16_t>(internal_rate_hz / output_rate_hz);
}

bool DeviceProfile::has_output_rate(int output_rate_hz) const noexcept {
    return std::ranges::find(output_rates_hz, output_rate_hz, &Coded::value) !=
           output_rates_hz.end();
}

Nanoseconds DeviceProfile::group_delay(const FilterSpec& filter) const noexcept {
    return Nanoseconds((filter.taps - 1) * kNanosecondsPerSecond / 2 / internal_rate_hz);
}

const FilterSpec* DeviceProfile::filter_named(std::string_view filter_name) const noexcept {
    const auto found = std::ranges::find(filters, filter_name, &FilterSpec::name);
    return found == filters.end() ? nullptr : &*found;
}

const FilterSpec* DeviceProfile::filter_coded(std::uint8_t code) const noexcept {
    const auto found = std::ranges::find(filters, code, &FilterSpec::code);
    return found == filters.end() ? nullptr : &*found;
}

std::vector<std::string_view> DeviceProfile::filters_allowed_at(int output_rate_hz) const {
    std::vector<std::string_view> names;
    for (const FilterSpec& filter : filters) {
        if (filter.code <= kLastBuiltInFilter &&
            std::ranges::count(filter.allowed_rates_hz, output_rate_hz) > 0) {
            names.push_back(filter.name);
        }
    }
    return names;
}

const DeviceProfile* find_profile(std::string_view name) noexcept {
    const auto found = std::ranges::find(kProfiles, name, &DeviceProfile::name);
    return found == kProfiles.end() ? nullptr : &*found;
}

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const DeviceProfile& profile : kProfiles) names.emplace_back(profile.name);
    return names;
}

}  // namespace a351::wire
