#include "protocol/wire/device_profile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace a351::wire {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

StandardGravity DeviceProfile::acceleration(std::int32_t counts) const noexcept {
    return StandardGravity(std::ldexp(static_cast<double>(counts), -acceleration_fraction_bits));
}

DegC DeviceProfile::temperature(std::int32_t counts) const noexcept {
    return DegC(temperature_slope_degc * static_cast<double>(counts) + temperature_offset_degc);
}

std::int32_t DeviceProfile::temperature_counts(DegC temperature) const noexcept {
    const double half_range = std::ldexp(1.0, temperature_bits - 1);
    const double counts = (temperature.value() - temperature_offset_degc) / temperature_slope_degc;
    return static_cast<std::int32_t>(
        std::clamp(std::floor(counts + 0.5), -half_range, half_range - 1.0));
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
        if (!filter.is_user && std::ranges::count(filter.allowed_rates_hz, output_rate_hz) > 0) {
            names.emplace_back(filter.name);
        }
    }
    return names;
}

}  // namespace a351::wire
