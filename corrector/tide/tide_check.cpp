#include "corrector/tide/tide_check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace a351::corrector::tide {
namespace {

/// A change of what is used, after which it may agree.
struct Change {
    std::chrono::minutes shift{0};
    double tide_sign = 1.0, latitude_sign = 1.0, longitude_sign = 1.0;
};

/// Returns the tide that differs most after the change; with size 0 if none differs.
Doubt largest_difference(const std::vector<UsedTide>& tides, const Agreement& agreement,
                         const TideOf& tide_of, const Change& change) {
    std::vector<double> differences_mgal;
    double mean_mgal = 0.0;
    for (const UsedTide& used : tides) {
        Station at = used.station;
        at.latitude = Degrees(change.latitude_sign * at.latitude.value());
        at.longitude = Degrees(change.longitude_sign * at.longitude.value());
        differences_mgal.push_back(change.tide_sign * used.tide_mgal -
                                   tide_of(used.time + change.shift, at).value());
        if (!agreement.is_constant_known)
            mean_mgal += differences_mgal.back() / static_cast<double>(tides.size());
    }
    Doubt largest;
    for (std::size_t i = 0; i < tides.size(); ++i)
        if (const double size_mgal = std::abs(differences_mgal[i] - mean_mgal);
            size_mgal > largest.size_mgal)
            largest = {i, size_mgal};
    return largest;
}

/// A change with what is left after it.
struct Fit {
    Change change;
    double size_mgal = std::numeric_limits<double>::infinity();
};

/// Returns up to a hundred tides, which are enough for a curve of half days, with the worst of all.
std::vector<UsedTide> sample_of(const std::vector<UsedTide>& tides, std::size_t worst) {
    constexpr std::size_t kMost = 100;
    std::vector<UsedTide> some{tides[worst]};
    for (std::size_t i = 0; i < tides.size(); i += tides.size() / kMost + 1)
        some.push_back(tides[i]);
    return some;
}

/// Returns the change after which the tides agree; absent if there is none, or not one only.
std::optional<Change> find_change(const std::vector<UsedTide>& tides, std::size_t worst,
                                  const Agreement& agreement, const TideOf& tide_of) {
    // A tide that hardly varies fits some other time of the day anyway.  0.05 mGal: a third of the
    // usual range of a day.
    constexpr double kLeastRange_mgal = 0.05;
    const auto [least, greatest] = std::ranges::minmax_element(tides, {}, &UsedTide::tide_mgal);
    if (greatest->tide_mgal - least->tide_mgal < kLeastRange_mgal) return std::nullopt;

    const std::vector<UsedTide> some = sample_of(tides, worst);
    const auto fit_of = [&](const Change& change) {
        return Fit{change, largest_difference(some, agreement, tide_of, change).size_mgal};
    };
    const auto best_of = [](const std::vector<Fit>& fits) {
        return *std::ranges::min_element(fits, {}, &Fit::size_mgal);
    };
    // Without such a gain half an hour would explain one mistyped tide.
    constexpr double kLeastGain = 3.0;
    const double limit_mgal = std::min(agreement.most_mgal, fit_of({}).size_mgal / kLeastGain);
    // Chosen: changes whose remains differ by less fit alike.
    const double alike_mgal = agreement.most_mgal / 4.0;

    const Fit sign =
        best_of({fit_of({{}, -1.0}), fit_of({{}, 1.0, -1.0}), fit_of({{}, 1.0, 1.0, -1.0})});
    // The shifts beside the best one fit nearly as well.
    constexpr std::chrono::minutes kStep{30}, kNear{60}, kDay{24 * 60};
    std::vector<Fit> shifts;
    for (auto shift = -kDay; shift <= kDay; shift += kStep)
        if (shift.count() != 0) shifts.push_back(fit_of({shift}));
    const Fit shift = best_of(shifts);
    // The other sign of a longitude or of the tide is much like some hours.
    const bool is_sign =
        sign.size_mgal <= limit_mgal && sign.size_mgal <= shift.size_mgal + alike_mgal;
    // The tide nearly returns after a lunar day.
    const bool is_shift =
        !is_sign && shift.size_mgal <= limit_mgal &&
        std::ranges::none_of(shifts, [&](const Fit& other) {
            return std::chrono::abs(other.change.shift - shift.change.shift) > kNear &&
                   other.size_mgal < shift.size_mgal + alike_mgal;
        });
    if (!is_sign && !is_shift) return std::nullopt;
    const Change& change = is_sign ? sign.change : shift.change;
    if (largest_difference(tides, agreement, tide_of, change).size_mgal > agreement.most_mgal)
        return std::nullopt;
    return change;
}

text::Message remedy_of(const Change& change) {
    if (change.tide_sign < 0.0) return text::message("; it fits with the other sign of the tide");
    if (change.latitude_sign < 0.0)
        return text::message("; it fits with the other sign of the latitude");
    if (change.longitude_sign < 0.0)
        return text::message("; it fits with the other sign of the longitude");
    return text::message("; it fits if {:+.1f} h are added to the times",
                         static_cast<double>(change.shift.count()) / 60.0);
}

}  // namespace

MilliGal usual_tide(UtcTime time, const Station& station) { return direct_tide(time, station); }

std::optional<Doubt> find_doubt(const std::vector<UsedTide>& tides, const Agreement& agreement,
                                const TideOf& tide_of) {
    Doubt doubt = largest_difference(tides, agreement, tide_of, {});
    if (doubt.size_mgal <= agreement.most_mgal) return std::nullopt;
    doubt.is_zero =
        std::ranges::all_of(tides, [](const UsedTide& used) { return used.tide_mgal == 0.0; });
    if (const auto change = find_change(tides, doubt.index, agreement, tide_of)) {
        doubt.has_other_sign = change->tide_sign < 0.0;
        doubt.remedy = remedy_of(*change);
    }
    return doubt;
}

}  // namespace a351::corrector::tide
