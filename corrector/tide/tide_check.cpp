#include "corrector/tide/tide_check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

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

/// @param worst  the tide that differs most.
text::Message find_remedy(const std::vector<UsedTide>& tides, const UsedTide& worst,
                          const Agreement& agreement, const TideOf& tide_of) {
    // A tide that hardly varies fits some other time of the day anyway.
    constexpr double kLeastRange_mgal = 0.05;
    const auto [least, greatest] = std::ranges::minmax_element(tides, {}, &UsedTide::tide_mgal);
    if (greatest->tide_mgal - least->tide_mgal < kLeastRange_mgal) return {};
    // A hundred readings are enough for a curve of half days.
    constexpr std::size_t kMost = 100;
    std::vector<UsedTide> some{worst};
    for (std::size_t i = 0; i < tides.size(); i += tides.size() / kMost + 1)
        some.push_back(tides[i]);
    const auto size_of = [&](const Change& change) {
        return largest_difference(some, agreement, tide_of, change).size_mgal;
    };
    // The other sign of a longitude or of the tide is much like some hours, so the best of all is named.
    double best_mgal = agreement.most_mgal;
    text::Message remedy;
    const auto take_if_better = [&](double size_mgal, const text::Message& sentence) {
        if (size_mgal >= best_mgal) return false;
        best_mgal = size_mgal;
        remedy = sentence;
        return true;
    };
    take_if_better(size_of({{}, -1.0}), text::message("; it fits the other sign of the tide"));
    take_if_better(size_of({{}, 1.0, -1.0}),
                   text::message("; it fits the other sign of the latitude"));
    take_if_better(size_of({{}, 1.0, 1.0, -1.0}),
                   text::message("; it fits the other sign of the longitude"));
    constexpr std::chrono::minutes kStep{30}, kNear{60}, kDay{24 * 60};
    std::map<std::chrono::minutes, double> size_mgal_of;
    std::optional<std::chrono::minutes> best_shift;
    for (auto shift = -kDay; shift <= kDay; shift += kStep) {
        if (shift.count() == 0) continue;
        const double size_mgal = size_mgal_of[shift] = size_of({shift});
        if (take_if_better(size_mgal, text::message("; it fits if {:+.1f} h are added to the times",
                                                    static_cast<double>(shift.count()) / 60.0)))
            best_shift = shift;
    }
    // The tide nearly returns after a lunar day.
    const double least_gap_mgal = agreement.most_mgal / 4.0;
    for (const auto& [shift, size_mgal] : size_mgal_of)
        if (best_shift && std::chrono::abs(shift - *best_shift) > kNear &&
            size_mgal < best_mgal + least_gap_mgal)
            return {};
    return remedy;
}

}  // namespace

std::optional<Doubt> find_doubt(const std::vector<UsedTide>& tides, const Agreement& agreement,
                                const TideOf& tide_of) {
    Doubt doubt = largest_difference(tides, agreement, tide_of, {});
    if (doubt.size_mgal <= agreement.most_mgal) return std::nullopt;
    doubt.is_zero =
        std::ranges::all_of(tides, [](const UsedTide& used) { return used.tide_mgal == 0.0; });
    doubt.remedy = find_remedy(tides, tides[doubt.index], agreement, tide_of);
    return doubt;
}

}  // namespace a351::corrector::tide
