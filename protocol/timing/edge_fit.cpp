#include "protocol/timing/edge_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace a351::timing {
namespace {

// Chosen on seeds 1 to 40 of clock_days_test; half or double each value gives similar errors.
constexpr double kShortestSpacing_ns = 0.7e6;  // smaller ones are jitter
constexpr double kPolling_ns = 1e6;            // frame of a full-speed USB bus
constexpr double kShortTimer_ns = 1e6;         // latency timer of an FTDI adapter at its shortest
constexpr double kWander_ns = 0.3e6;           // wander of the oscillators within 900 s
constexpr double kSlack_ns = 0.1e6;            // added to the least distance that fits the points
constexpr double kSeenTimer_ns = 0.5e6;        // scatter of the least delays above any jitter
constexpr double kPause_ns = 1e6;              // distance of pauses above the hidden delay
constexpr std::int64_t kHighShare = 20;        // more than 1 point in 20 is above a timer: polling
constexpr double kTimerKnown_ns = 600e9;       // two beats of a timer 3 ppm from in step

// Latency timer of an FTDI adapter as delivered (AN232B-04, section 3.3); assumed until the
// arrivals show a timer.
constexpr double kUnseenTimer_ns = 16e6;

struct Point {
    double x, y;  // due after `at`, and arrival after due; ns
};

/// Returns the level at x = 0 of the highest line of this slope below all points.
double level_below(const std::vector<Point>& lower_hull, double slope) {
    double level = std::numeric_limits<double>::infinity();
    for (const Point& p : lower_hull) level = std::min(level, p.y - slope * p.x);
    return level;
}

/// Returns the level at x = 0 of the lowest line of this slope above all points.
double level_above(const std::vector<Point>& upper_hull, double slope) {
    double level = -std::numeric_limits<double>::infinity();
    for (const Point& p : upper_hull) level = std::max(level, p.y - slope * p.x);
    return level;
}

/// Returns the convex hull of points in rising order of x; side 1: lower, -1: upper.
std::vector<Point> hull(const std::vector<Point>& points, double side) {
    std::vector<Point> hull;
    for (const Point& p : points) {
        while (hull.size() > 1) {
            const Point& a = hull[hull.size() - 2];
            const Point& b = hull.back();
            const double turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
            if (side * turn > 0.0) break;
            hull.pop_back();
        }
        hull.push_back(p);
    }
    return hull;
}

// Steps that reduce the interval to 1e-5: 2e-3 ppm, 2 us in the window.
constexpr int kSteps = 24;

/// Returns the place where a convex function is least: golden section.
template <class Convex>
double argmin(Convex f, double from, double to) {
    constexpr double kGolden = 0.6180339887498949;
    double left = to - kGolden * (to - from), right = from + kGolden * (to - from);
    double at_left = f(left), at_right = f(right);
    for (int i = 0; i < kSteps; ++i) {
        if (at_left <= at_right) {
            to = right;
            right = left;
            at_right = at_left;
            left = to - kGolden * (to - from);
            at_left = f(left);
        } else {
            from = left;
            left = right;
            at_left = at_right;
            right = from + kGolden * (to - from);
            at_right = f(right);
        }
    }
    return at_left <= at_right ? left : right;
}

/// Returns the last place from `inside` towards `limit` at which a convex function is not positive.
/// It is not positive at `inside`.
template <class Convex>
double last_not_positive(Convex f, double inside, double limit) {
    if (f(limit) <= 0.0) return limit;
    for (int i = 0; i < kSteps; ++i) {
        const double middle = 0.5 * (inside + limit);
        (f(middle) <= 0.0 ? inside : limit) = middle;
    }
    return inside;
}

/// Set of lines between an upper and a lower hull.
struct Strip {
    std::vector<Point> lower, upper;
    double least_slope, largest_slope;

    /// Returns the vertical distance of the two lines of this slope that touch the hulls.
    [[nodiscard]] double depth(double slope) const {
        return level_above(upper, slope) - level_below(lower, slope);
    }
    /// Returns the slope of least depth.
    [[nodiscard]] double flattest() const {
        return argmin([this](double slope) { return depth(slope); }, least_slope, largest_slope);
    }

    struct Range {
        double top, bottom;  // levels
        double least_slope, largest_slope;
    };
    /// Returns the range of the lines that lie at most `most` below any point.
    /// @param most  at least the depth at `flattest`.
    [[nodiscard]] Range lines(double most, double flattest) const {
        const auto excess = [&](double slope) { return depth(slope) - most; };
        const double least = last_not_positive(excess, flattest, least_slope);
        const double largest = last_not_positive(excess, flattest, largest_slope);
        const auto below = [this](double slope) { return -level_below(lower, slope); };
        const auto above = [this](double slope) { return level_above(upper, slope); };
        return {-below(argmin(below, least, largest)), above(argmin(above, least, largest)) - most,
                least, largest};
    }
};

double to_ns(Nanoseconds duration) { return static_cast<double>(duration.count()); }

/// Returns the spacing that four blocks in five do not exceed: a busy host fills spacings, it does
/// not widen them.
std::optional<Nanoseconds> usual_spacing(std::span<const ArrivalBlock> blocks) {
    std::vector<Nanoseconds> spacings;
    for (const ArrivalBlock& block : blocks)
        if (block.spacing) spacings.push_back(*block.spacing);
    if (spacings.empty()) return std::nullopt;
    const auto usual = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() * 4 / 5);
    std::nth_element(spacings.begin(), usual, spacings.end());
    return *usual;
}

/// Returns the points without pauses of the host.  Pauses lie far above the line that is closest
/// below all points on average.
std::vector<Point> without_pauses(const std::vector<Point>& points, const Strip& strip,
                                  double most_above) {
    double mean_x = 0.0;
    for (const Point& p : points) mean_x += p.x;
    mean_x /= static_cast<double>(points.size());
    const auto depth_at_mean = [&](double slope) {
        return -(level_below(strip.lower, slope) + slope * mean_x);
    };
    const double slope = argmin(depth_at_mean, strip.least_slope, strip.largest_slope);
    const double level = level_below(strip.lower, slope);
    std::vector<Point> kept;
    kept.reserve(points.size());
    for (const Point& p : points)
        if (p.y - level - slope * p.x <= most_above) kept.push_back(p);
    return kept;
}

/// Returns false if a single short timer explains the points: they cover enough time, and hardly
/// any lies higher than this timer allows.
bool may_be_polled(const std::vector<Point>& points, const Strip& strip) {
    if (points.back().x - points.front().x < kTimerKnown_ns) return true;
    const double slope = strip.flattest();
    const double most = level_below(strip.lower, slope) + kShortTimer_ns + kWander_ns;
    const auto high =
        std::ranges::count_if(points, [&](const Point& p) { return p.y - slope * p.x > most; });
    return kHighShare * high > std::ssize(points);
}

}  // namespace

EdgeFit fit_edge(std::span<const ArrivalBlock> blocks, Nanoseconds at, Nanoseconds sample_period,
                 RateLimits limits) {
    std::vector<Point> points;
    points.reserve(blocks.size());
    for (const ArrivalBlock& block : blocks)
        points.push_back({to_ns(block.due - at), to_ns(block.least_y)});

    const auto usual = usual_spacing(blocks);
    const double spacing = usual ? to_ns(*usual) : 0.0;
    const bool has_spacing =
        spacing > kShortestSpacing_ns && spacing < to_ns(sample_period) + kPolling_ns;
    const double hidden = (has_spacing ? spacing : kShortTimer_ns) + kPolling_ns + kWander_ns;

    Strip strip{hull(points, 1.0), {}, limits.least, limits.largest};
    strip.upper = hull(without_pauses(points, strip, hidden + kPause_ns), -1.0);
    const double flattest = strip.flattest();
    const double needed = strip.depth(flattest) + kSlack_ns;
    const Strip::Range allowed = strip.lines(std::max(hidden, needed), flattest);

    // Without a spacing, points that scatter show a timer, the polling of a bus, or both.
    const bool has_short_timer = !has_spacing && needed > kSeenTimer_ns;
    const double likely_hidden =
        has_short_timer ? kShortTimer_ns + (may_be_polled(points, strip) ? kPolling_ns : 0.0) : 0.0;
    const Strip::Range likely =
        has_spacing ? allowed : strip.lines(std::max(likely_hidden, needed), flattest);
    const double slope = 0.5 * (likely.least_slope + likely.largest_slope);
    const double level = has_spacing || has_short_timer ? 0.5 * (likely.top + likely.bottom)
                                                        : level_below(strip.lower, slope);

    const double busy = std::max(needed - hidden, 0.0);
    const double uncertainty = std::max(allowed.top - level, level - allowed.bottom) +
                               2.0 * kSlack_ns + busy + (usual ? 0.0 : kUnseenTimer_ns);
    return {.y = Nanoseconds(std::llround(level)),
            .skew = slope,
            .uncertainty = Nanoseconds(std::llround(uncertainty)),
            .skew_uncertainty = 0.5 * (allowed.largest_slope - allowed.least_slope)};
}

}  // namespace a351::timing
