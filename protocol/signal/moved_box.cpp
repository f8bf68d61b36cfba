#include "protocol/signal/moved_box.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace a351::signal {
namespace {

constexpr double kShaken_mgal = 2000.0;         // a hand gives 5 Gal or more
constexpr std::ptrdiff_t kHandled = 3;          // samples: 5 s
constexpr std::size_t kReach = 5;               // samples: 10 s
constexpr std::size_t kCompared = 10;           // samples: 20 s, the ripple of 50 s is below 1 mGal
constexpr double kMoved_deg = 0.02;             // beyond what soft ground gives way in 20 s
constexpr double kHandledAndMoved_deg = 0.005;  // a placement is levelled to 0.1 deg
constexpr double kHandledAndMoved_mgal = 10.0;

struct Level {
    std::array<double, 3> axes_mgal{};
    double norm_mgal = 0.0;
};

Level mean_of(std::span<const MotionSample> samples, std::span<const std::size_t> places) {
    Level mean;
    const auto n = static_cast<double>(places.size());
    for (const std::size_t i : places) {
        const auto& axes = samples[i].axes;
        for (std::size_t k = 0; k < axes.size(); ++k) mean.axes_mgal[k] += axes[k].value() / n;
        mean.norm_mgal += std::hypot(axes[0].value(), axes[1].value(), axes[2].value()) / n;
    }
    return mean;
}

}  // namespace

bool is_shaken(const MotionSample& sample) { return sample.shake.value() > kShaken_mgal; }

std::vector<bool> at_rest(std::span<const MotionSample> samples) {
    std::vector<bool> rest(samples.size());
    std::size_t clean = kReach;  // samples since the last shaken one
    for (std::size_t i = 0; i < samples.size(); ++i) {
        clean = is_shaken(samples[i]) ? 0 : clean + 1;
        double sum = 0.0;
        for (const MilliGal axis : samples[i].axes) sum += axis.value();
        rest[i] = clean > kReach && std::isfinite(sum);
    }
    clean = kReach;
    for (std::size_t i = samples.size(); i-- > 0;) {
        clean = is_shaken(samples[i]) ? 0 : clean + 1;
        if (clean <= kReach) rest[i] = false;
    }
    return rest;
}

bool is_handled(std::span<const MotionSample> samples, std::size_t from, std::size_t to) {
    return std::ranges::count_if(samples.subspan(from, to - from), is_shaken) >= kHandled;
}

std::vector<BoxMove> find_box_moves(std::span<const MotionSample> samples) {
    const std::vector<bool> rest = at_rest(samples);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (rest[i]) places.push_back(i);
    std::vector<BoxMove> moves;
    const std::span<const std::size_t> all(places);
    std::size_t best = 0;      // place of the largest change of the move that is looked at
    double best_change = 0.0;  // in units of its threshold
    BoxMove found;
    for (std::size_t k = kCompared; k + kCompared <= places.size(); ++k) {
        const Level before = mean_of(samples, all.subspan(k - kCompared, kCompared)),
                    after = mean_of(samples, all.subspan(k, kCompared));
        double square = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            square += std::pow(after.axes_mgal[axis] - before.axes_mgal[axis], 2);
        const double tilt_deg = std::sqrt(square) / kMilliGalPerStandardGravity / kRadPerDeg;
        const double norm_mgal = after.norm_mgal - before.norm_mgal;
        double change = tilt_deg / kMoved_deg;
        if (is_handled(samples, places[k - 1], places[k]))
            change = std::max({change, tilt_deg / kHandledAndMoved_deg,
                               std::abs(norm_mgal) / kHandledAndMoved_mgal});
        if (best_change > 0.0 && k >= best + kCompared) {
            moves.push_back(found);
            best_change = 0.0;
        }
        if (change > 1.0 && change > best_change) {
            best = k;
            best_change = change;
            found = {places[k - 1], places[k], tilt_deg, MilliGal(norm_mgal)};
        }
    }
    if (best_change > 0.0) moves.push_back(found);
    return moves;
}

}  // namespace a351::signal
