#include "corrector/reading/interval.hpp"

#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

namespace a351::corrector::reading {
namespace {

constexpr std::size_t kMargin = 30;

/// Returns a curve of `n` samples with extrema at 50, 100, 150, ... (a maximum first).
std::vector<double> wave(std::size_t n) {
    std::vector<double> curve(n);
    for (std::size_t i = 0; i < n; ++i)
        curve[i] = -std::cos(std::numbers::pi * static_cast<double>(i) / 50.0);
    return curve;
}

std::vector<bool> disturbed_at(std::size_t n, std::initializer_list<std::size_t> indices) {
    std::vector<bool> disturbed(n);
    for (const std::size_t i : indices) disturbed[i] = true;
    return disturbed;
}

struct Expected {
    std::size_t first, last;
    bool disturbed_first = false, disturbed_last = false, split = false, fallback = false;
};

/// Checks the choice of the part and then of the interval, for a curve that is the same for any
/// part.
void check(const std::vector<double>& curve, const std::vector<bool>& disturbed,
           const Expected& expected) {
    const Part part = choose_part(disturbed, kMargin);
    const auto of_part = std::span(curve).subspan(part.first, part.last - part.first + 1);
    const Interval found = choose_interval(of_part, part.disturbed_first, part.disturbed_last);
    CHECK(part.first + found.first == expected.first);
    CHECK(part.first + found.last == expected.last);
    CHECK(part.disturbed_first == expected.disturbed_first);
    CHECK(part.disturbed_last == expected.disturbed_last);
    CHECK(part.split == expected.split);
    CHECK(found.fallback == expected.fallback);
}

}  // namespace

TEST_CASE("an undisturbed record is used completely") {
    check(wave(440), disturbed_at(440, {}), {0, 439});
}

TEST_CASE("at a disturbed side the interval starts or ends at the second extremum from it") {
    const auto curve = wave(440);
    check(curve, disturbed_at(440, {3}), {100, 439, true});
    check(curve, disturbed_at(440, {30}), {100, 439, true});
    check(curve, disturbed_at(440, {439}), {0, 350, false, true});
    check(curve, disturbed_at(440, {409}), {0, 350, false, true});
    check(curve, disturbed_at(440, {0, 430}), {100, 350, true, true});
}

TEST_CASE(
    "a pulse within the record splits it, and the longer part is used as disturbed at the cut") {
    const auto curve = wave(440);
    check(curve, disturbed_at(440, {120, 121}), {200, 439, true, false, true});
    check(curve, disturbed_at(440, {320}), {0, 250, false, true, true});
    // Between two pulses: extrema at 100 ... 350 are inside 81 ... 359.
    check(curve, disturbed_at(440, {80, 360}), {150, 300, true, true, true});
    // One sample nearer to the end it would belong to the end.
    check(curve, disturbed_at(440, {31}), {100, 439, true, false, true});
    check(curve, disturbed_at(440, {408}), {0, 350, false, true, true});
}

TEST_CASE("a disturbed side with only one extremum uses that one and is flagged") {
    check(wave(90), disturbed_at(90, {2}), {50, 89, true, false, false, true});
    check(wave(90), disturbed_at(90, {88}), {0, 50, false, true, false, true});
}

TEST_CASE(
    "an interval that would be empty runs from the first to the last extremum and is flagged") {
    // Extrema 50, 100: the second from the left is to the right of the second from the right.
    check(wave(140), disturbed_at(140, {2, 138}), {50, 100, true, true, false, true});
    // Extrema 50, 100, 150: both are the same sample.
    check(wave(190), disturbed_at(190, {2, 188}), {50, 150, true, true, false, true});
}

TEST_CASE("without extrema the whole part is used and flagged") {
    check(wave(45), disturbed_at(45, {2}), {0, 44, true, false, false, true});
    check(wave(90), disturbed_at(90, {2, 88}),
          {0, 89, true, true, false, true});  // one extremum, needed by both sides
}

TEST_CASE("a flat extremum counts once, at its middle rounded down") {
    std::vector<double> curve = wave(440);
    for (std::size_t i = 97; i <= 104; ++i) curve[i] = curve[97];
    check(curve, disturbed_at(440, {3}), {100, 439, true});
    for (std::size_t i = 97; i <= 105; ++i) curve[i] = curve[97];
    check(curve, disturbed_at(440, {3}), {101, 439, true});
}

TEST_CASE("curves of one to five samples are accepted") {
    for (std::size_t n = 1; n <= 5; ++n) {
        check(std::vector<double>(n, 1.0), std::vector<bool>(n, true),
              {0, n - 1, true, true, false, true});
    }
}

}  // namespace a351::corrector::reading
