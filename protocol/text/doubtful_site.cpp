#include "protocol/text/doubtful_site.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "protocol/core/normal_gravity.hpp"

namespace a351::text {
namespace {

constexpr double kNear_m = 100e3;
constexpr double kMostAltitude_m = 1500.0;
constexpr double kMostAnomaly_mgal = 300.0;

/// A site and by how much it differs from what was expected.
struct Doubt {
    const Site* site = nullptr;
    double size = 0.0;  ///< Its sign is kept.
};

/// Returns the site with the largest size above a limit.  A size that is not known is NaN.
Doubt worst(const std::vector<const Site*>& sites, double limit,
            const std::function<double(const Site&)>& size_of) {
    Doubt found{nullptr, limit};
    for (const Site* const site : sites)
        if (const double size = size_of(*site); std::abs(size) > std::abs(found.size))
            found = {site, size};
    return found;
}

/// Returns a name in lower case, without blanks and the zeros that do not change a number.
std::string folded(std::string_view name) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    std::string text;
    for (const char c : name)
        if (c != ' ') text += c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
    std::string short_text;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && is_digit(text[end])) ++end;
        if (end == i) {
            short_text += text[i++];
            continue;
        }
        std::string digits = text.substr(i, end - i);
        const bool is_fraction = i >= 2 && text[i - 1] == '.' && is_digit(text[i - 2]);
        if (!is_fraction) {
            short_text += digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
        } else if (digits.find_first_not_of('0') == std::string::npos) {
            short_text.pop_back();  // the point
        } else {
            short_text += digits;
        }
        i = end;
    }
    return short_text;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

bool differ_in_writing(std::string_view one, std::string_view other) {
    return one != other && folded(one) == folded(other);
}

Message doubtful_site(const std::vector<Site>& sites, const Site* station) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<const Site*> placed;
    for (const Site& site : sites)
        if (site.is_placed) placed.push_back(&site);
    const auto from = [](const Site& site, const Site& other) {
        return distance(site, other.latitude, other.longitude).value();
    };

    const auto nearest = [&](const Site& site) {
        Doubt found{nullptr, std::numeric_limits<double>::infinity()};
        for (const Site* const other : placed)
            if (other != &site && from(site, *other) < found.size)
                found = {other, from(site, *other)};
        return found;
    };
    const Doubt far = worst(placed, kNear_m, [&](const Site& site) {
        const Doubt other = nearest(site);
        return other.site ? other.size : kUnknown;
    });
    if (far.site)
        return message(
            "{} is {:.0f} km from {}, the nearest other site: check longitude and latitude of both",
            far.site->name, far.size / 1000.0, nearest(*far.site).site->name);

    if (station != nullptr && !placed.empty())
        if (const Doubt other = nearest(*station); other.size > kNear_m)
            return message("{} is {:.0f} km from {}, the nearest site: check both positions",
                           station->name, other.size / 1000.0, other.site->name);

    const Doubt high = worst(placed, kMostAltitude_m, [&](const Site& site) {
        std::vector<double> near_m;
        for (const Site* const other : placed)
            if (other != &site && other->has_altitude && from(site, *other) < kNear_m)
                near_m.push_back(other->altitude.value());
        const bool is_known = site.has_altitude && near_m.size() >= 2;
        return is_known ? site.altitude.value() - median(std::move(near_m)) : kUnknown;
    });
    if (high.site)
        return message("the altitude of {} differs by {:+.0f} m from its neighbours: check it",
                       high.site->name, high.size);

    const Doubt heavy = worst(placed, kMostAnomaly_mgal, [&](const Site& site) {
        if (!site.gravity || !site.has_altitude) return kUnknown;
        return (*site.gravity - normal_gravity(site.latitude, site.altitude)).value();
    });
    if (heavy.site)
        return message(
            "the reference of {} differs by {:+.0f} mGal from normal gravity at its latitude and "
            "altitude: check all three",
            heavy.site->name, heavy.size);

    std::map<std::string, const Site*> names;
    for (const Site& site : sites)
        if (const auto [other, is_new] = names.try_emplace(folded(site.name), &site); !is_new)
            return message(
                "the names {} and {} differ only in capitals, blanks or zeros: use one of them",
                other->second->name, site.name);
    return {};
}

}  // namespace a351::text
