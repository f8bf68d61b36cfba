#include "corrector/eemd/extrema.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector {
namespace {

using Numbers = std::vector<double>;

struct Found {
    Numbers maxima;
    Numbers minima;
};

Found find(const Numbers& curve) {
    EnvelopeKnots maxima(curve.size());
    EnvelopeKnots minima(curve.size());
    find_extrema(curve, maxima, minima);
    const auto copy = [](std::span<const double> s) { return Numbers(s.begin(), s.end()); };
    return {copy(maxima.extrema_positions()), copy(minima.extrema_positions())};
}

}  // namespace

TEST_CASE("maxima and minima of any series alternate and agree with the plain count") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Numbers curve = white_noise(300, seed);
        for (double& value : curve) value = std::round(2.0 * value);  // plateaus of every length
        const Found found = find(curve);
        CHECK(found.maxima.size() + found.minima.size() == count_extrema(curve));
        Numbers all = found.maxima;
        all.insert(all.end(), found.minima.begin(), found.minima.end());
        std::sort(all.begin(), all.end());
        for (std::size_t i = 1; i < all.size(); ++i) {
            CHECK(std::count(found.maxima.begin(), found.maxima.end(), all[i]) +
                      std::count(found.maxima.begin(), found.maxima.end(), all[i - 1]) ==
                  1);
        }
        const auto indices = extremum_indices(curve);
        REQUIRE(indices.size() == all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            CHECK(static_cast<double>(indices[i]) == std::floor(all[i]));
        }
    }
}

TEST_CASE("a plateau is one extremum at its middle, which may fall between samples") {
    CHECK(find({0, 1, 1, 1, 0}).maxima == Numbers{2.0});
    CHECK(find({0, 1, 1, 0}).maxima == Numbers{1.5});
    CHECK(find({0, -1, -1, 0}).minima == Numbers{1.5});
}

TEST_CASE("a terrace is no extremum") {
    const Found found = find({0, 1, 1, 2, 3});
    CHECK(found.maxima.empty());
    CHECK(found.minima.empty());
}

TEST_CASE("a plateau that touches an end is no extremum") {
    const Found found = find({1, 1, 0, 2, 2});
    CHECK(found.maxima.empty());
    CHECK(found.minima == Numbers{2.0});
}

TEST_CASE("series of no, one and two samples have no extrema") {
    for (const Numbers& curve : {Numbers{}, Numbers{1}, Numbers{1, 2}}) {
        CHECK(find(curve).maxima.empty());
        CHECK(find(curve).minima.empty());
    }
}

TEST_CASE("the densest alternation fits into the knots") {
    for (std::size_t n = 0; n < 40; ++n) {
        Numbers curve(n);
        for (std::size_t i = 0; i < n; ++i) curve[i] = i % 2 == 0 ? 1.0 : -1.0;
        const Found found = find(curve);
        CHECK(found.maxima.size() + found.minima.size() == (n < 2 ? 0 : n - 2));
    }
}

TEST_CASE("the line through two extrema replaces an end only when it lies outside") {
    // Maxima (1, 3), (3, 2): the line gives 3.5 at 0 and 1 at 5.
    const Numbers curve = {0, 3, 0, 2, 0, 1.5};
    EnvelopeKnots maxima(curve.size());
    EnvelopeKnots minima(curve.size());
    find_extrema(curve, maxima, minima);
    add_end_knots(curve, maxima, minima);
    CHECK(maxima.values().front() == 3.5);
    CHECK(maxima.values().back() == 1.5);
    CHECK(maxima.positions().back() == 5.0);
    CHECK(minima.values().front() == 0.0);
    CHECK(minima.values().back() == 0.0);
}

}  // namespace a351::corrector
