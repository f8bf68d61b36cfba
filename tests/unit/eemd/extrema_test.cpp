#include "corrector/eemd/extrema.hpp"

#include "tests/support/catch.hpp"

#include "corrector/eemd/knots.hpp"
#include "corrector/eemd/sift_kernels.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

using Numbers = std::vector<double>;

struct Found {
    Numbers maxima, minima;
};

Numbers copy(std::span<const double> values) { return {values.begin(), values.end()}; }

AlternatingKnots extrema_of(const Numbers& curve) {
    AlternatingKnots knots(curve.size());
    if (curve.empty()) return knots;
    Numbers padded = curve;
    padded.resize(curve.size() + 3);
    const auto [positions, values, starts] = knots.buffers();
    const std::size_t count =
        fastest_kernels().find_extrema(padded.data(), curve.size(), positions, values, starts);
    knots.take(count, count > 0 && values[0] > curve[0]);
    return knots;
}

Found find(const Numbers& curve) {
    const AlternatingKnots knots = extrema_of(curve);
    Found found;
    bool maximum = knots.first_is_maximum();
    for (const double position : knots.extrema_positions()) {
        (maximum ? found.maxima : found.minima).push_back(position);
        maximum = !maximum;
    }
    return found;
}

}  // namespace

TEST_CASE("maxima and minima of any series alternate and agree with a simple count") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Numbers curve = white_noise(300, seed);
        for (double& value : curve) value = std::round(2.0 * value);  // plateaus of every length
        const Found found = find(curve);
        CHECK(found.maxima.size() + found.minima.size() == count_extrema(curve));
        Numbers all = found.maxima;
        all.insert(all.end(), found.minima.begin(), found.minima.end());
        std::sort(all.begin(), all.end());
        for (std::size_t i = 1; i < all.size(); ++i)
            CHECK(std::count(found.maxima.begin(), found.maxima.end(), all[i]) +
                      std::count(found.maxima.begin(), found.maxima.end(), all[i - 1]) ==
                  1);
        const auto indices = extremum_indices(curve);
        REQUIRE(indices.size() == all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            CHECK(static_cast<double>(indices[i]) == std::floor(all[i]));
    }
}

TEST_CASE("a plateau is one extremum at its middle, which may fall between samples") {
    CHECK(find({0, 1, 1, 1, 0}).maxima == Numbers{2.0});
    CHECK(find({0, 1, 1, 0}).maxima == Numbers{1.5});
    CHECK(find({0, -1, -1, 0}).minima == Numbers{1.5});
}

TEST_CASE("a step on a slope and a plateau at an end are no extrema, and two samples have none") {
    for (const Numbers& curve :
         {Numbers{0, 1, 1, 2, 3}, Numbers{}, Numbers{1}, Numbers{1, 2}, Numbers{1, 1, 0, 2, 2}}) {
        CHECK(find(curve).maxima.empty());
        CHECK(find(curve).minima == (curve == Numbers{1, 1, 0, 2, 2} ? Numbers{2.0} : Numbers{}));
    }
}

TEST_CASE("a series in which every inner sample is an extremum fits into the knots") {
    for (std::size_t n = 0; n < 40; ++n) {
        Numbers curve(n);
        for (std::size_t i = 0; i < n; ++i) curve[i] = i % 2 == 0 ? 1.0 : -1.0;
        const Found found = find(curve);
        CHECK(found.maxima.size() + found.minima.size() == (n < 2 ? 0 : n - 2));
    }
}

TEST_CASE("segments begin at the first sample at or after an extremum") {
    const Numbers curve = {0, 1, 1, 0, -1, 0, 0};  // maximum at 1.5, minimum at 4
    CHECK(extrema_of(curve).segment_starts()[0] == (1U << 2 | 1U << 4));
    Numbers wave(200);
    for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = std::sin(static_cast<double>(i));
    const AlternatingKnots knots = extrema_of(wave);
    std::size_t found = 0;
    for (const double position : knots.extrema_positions()) {
        const auto i = static_cast<std::size_t>(position);
        found += knots.segment_starts()[i / 64] >> (i % 64) & 1;
    }
    CHECK(found == count_extrema(wave));
}

TEST_CASE(
    "the line through the two outermost extrema replaces an end value only if it lies outside") {
    // Maxima (1, 3), (3, 2): the line gives 3.5 at 0 and 1 at 5.
    const Numbers curve = {0, 3, 0, 2, 0, 1.5};
    AlternatingKnots knots = extrema_of(curve);
    knots.add_ends(curve, EndRule::line);
    CHECK(copy(knots.positions()) == Numbers{0, 0, 1, 2, 3, 4, 5, 5});
    CHECK(copy(knots.values()) == Numbers{3.5, 0, 3, 0, 2, 0, 1.5, 0});
}

TEST_CASE("mirrored extrema continue to alternate beyond the ends") {
    // The mirror is the outermost extremum if the end sample lies within, else the end sample.
    for (const auto& [curve, values] :
         {std::pair(Numbers{1, 3, 0, 2, 0, 3, 1}, Numbers{3, 0, 2, 0, 3, 0, 2, 0, 3, 0, 2, 0, 3}),
          {{-1, 3, 0, 2, 0, 3, -1}, {2, 0, 3, -1, 3, 0, 2, 0, 3, -1, 3, 0, 2}}}) {
        AlternatingKnots knots = extrema_of(curve);
        knots.add_ends(curve, EndRule::mirror);
        CHECK(copy(knots.positions()) == Numbers{-3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
        CHECK(copy(knots.values()) == values);
    }
}

}  // namespace a351::corrector::eemd
