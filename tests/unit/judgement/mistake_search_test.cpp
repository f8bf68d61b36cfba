#include "corrector/judgement/mistake_search.hpp"

#include <cmath>

#include "corrector/adjustment/dense_residuals.hpp"
#include "corrector/judgement/mistake_trial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/long_tests.hpp"

using namespace a351::corrector;
using judgement::Mistake;
using MistakeKind = adjustment::AlternativeKind;
using judgement::SearchedReading;
using judgement::Trial;

namespace {

constexpr double kNoise_mgal = 1.5;

/// Returns 18 readings: A at both ends and in the middle, a stay of two set-ups at E.
std::vector<SearchedReading> readings() {
    std::vector<SearchedReading> list;
    const std::vector<std::pair<std::string, int>> stays{
        {"A", 1}, {"B", 1}, {"C", 1}, {"D", 1}, {"E", 1}, {"E", 1}, {"F", 1}, {"G", 1}, {"A", 2},
        {"H", 1}, {"I", 1}, {"J", 1}, {"K", 1}, {"L", 1}, {"M", 1}, {"N", 1}, {"A", 3}, {"B", 2}};
    for (const auto& [site, number] : stays) {
        SearchedReading& reading = list.emplace_back();
        reading.site = site;
        reading.occupation = number;
        reading.reference_mgal = 979800.0 + 6.0 * (site.front() - 'A');
    }
    return list;
}

/// A survey with an unknown constant and drift; the noise is white.
struct MadeUp final : adjustment::Trials {
    std::vector<SearchedReading> list = readings();
    Eigen::VectorXd errors_mgal;

    explicit MadeUp(std::uint64_t seed) {
        std::mt19937_64 generator(seed);
        adjustment::DenseResiduals white;
        const auto n = std::ssize(list);
        white.values = Eigen::VectorXd::Zero(n);
        white.unknown = Eigen::MatrixXd::Zero(n, 0);
        errors_mgal = kNoise_mgal * white.simulated(generator);
    }

    void add(std::size_t from, std::size_t end, double mgal) {
        for (std::size_t i = from; i < end; ++i) errors_mgal(static_cast<Eigen::Index>(i)) += mgal;
    }

    /// Returns the residuals without the readings of known mistakes; a step is one more unknown.
    [[nodiscard]] adjustment::DenseResiduals dense(
        const std::vector<adjustment::Alternative>& known) const {
        const auto n = std::ssize(list);
        Eigen::MatrixXd a(n, 2);
        Eigen::VectorXd y = errors_mgal;
        for (Eigen::Index i = 0; i < n; ++i) a.row(i) << 1.0, static_cast<double>(i);
        for (const adjustment::Alternative& one : known) {
            const auto unknown = [&](const std::vector<std::size_t>& numbers) {
                a.conservativeResize(Eigen::NoChange, a.cols() + 1);
                a.rightCols(1).setZero();
                for (const std::size_t i : numbers)
                    a(static_cast<Eigen::Index>(i), a.cols() - 1) = 1.0;
            };
            if (one.kind == MistakeKind::swap) {
                for (const std::size_t i : one.readings)
                    y(static_cast<Eigen::Index>(i)) -= one.size_mgal;
                for (const std::size_t i : one.others)
                    y(static_cast<Eigen::Index>(i)) += one.size_mgal;
            } else {
                unknown(one.readings);
            }
        }
        adjustment::DenseResiduals dense;
        dense.unknown = adjustment::orthonormal_basis(a);
        dense.values = y / kNoise_mgal;
        dense.project(dense.values);
        dense.whitening = Eigen::MatrixXd::Identity(n, n) / kNoise_mgal;
        dense.to_scatter = Eigen::MatrixXd::Identity(n, n);
        return dense;
    }

    [[nodiscard]] std::shared_ptr<const adjustment::Residuals> residuals(
        const std::vector<adjustment::Alternative>& known,
        const std::vector<adjustment::Alternative>& /*quiet*/) override {
        return adjustment::effects_on(dense(known));
    }

    [[nodiscard]] std::vector<Mistake> search() { return judgement::search_mistakes(list, *this); }
};

using Numbers = std::vector<std::size_t>;

}  // namespace

TEST_CASE("a reading, a reference, a swap and a step are found with their sizes") {
    MadeUp stay(1), set_up(2), station(3), swap(4), step(5);
    stay.add(8, 9, 14.0);
    set_up.add(5, 6, -12.0);
    station.add(1, 2, 15.0);
    station.add(17, 18, 15.0);
    swap.add(3, 4, 36.0);  // J was read under the name of D
    swap.add(11, 12, -36.0);
    step.add(7, 18, -11.0);
    const struct {
        MadeUp& survey;
        MistakeKind kind;
        Numbers readings, others;
        double size_mgal;
    } cases[]{{stay, MistakeKind::stay, {8}, {}, 14.0},
              {set_up, MistakeKind::set_up, {5}, {}, -12.0},
              {station, MistakeKind::station, {1, 17}, {}, 15.0},
              {swap, MistakeKind::swap, {3}, {11}, 36.0},
              {step, MistakeKind::step, {7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}, {}, -11.0}};
    for (const auto& expected : cases) {
        const auto found = expected.survey.search();
        REQUIRE(found.size() == 1);
        CHECK(found[0].kind == expected.kind);
        CHECK(found[0].readings == expected.readings);
        CHECK(found[0].others == expected.others);
        CHECK(std::abs(found[0].size_mgal - expected.size_mgal) <= 3.0 * found[0].u_mgal);
        CHECK(found[0].p < 0.001);
    }
}

TEST_CASE("in two faces no step is searched for, because one of the bias has two signs") {
    MadeUp survey(5);
    survey.add(7, 18, -11.0);
    CHECK(survey.search().at(0).kind == MistakeKind::step);
    for (std::size_t i = 1; i < survey.list.size(); i += 2) survey.list[i].face = -1;
    for (const Mistake& found : survey.search()) CHECK(found.kind != MistakeKind::step);
}

TEST_CASE("several mistakes of one day are found together") {
    MadeUp day(6);
    day.add(2, 3, 40.0);   // C
    day.add(6, 7, -20.0);  // F
    day.add(9, 18, 15.0);  // step
    auto found = day.search();
    REQUIRE(found.size() == 3);
    std::ranges::sort(found, {}, [](const Mistake& one) { return one.readings.front(); });
    CHECK(found[0].readings == Numbers{2});
    CHECK(found[1].readings == Numbers{6});
    CHECK(found[2].kind == MistakeKind::step);
    CHECK(found[2].readings.front() == 9);
}

TEST_CASE("mistakes that cancel each other explain nothing together") {
    MadeUp real(7), clean(7);
    real.add(3, 4, 36.0);
    real.add(11, 12, -36.0);
    const auto swap = [](std::size_t one, std::size_t other) {
        Mistake mistake;
        mistake.kind = MistakeKind::swap;
        mistake.readings = {one};
        mistake.others = {other};
        mistake.size_mgal = 36.0;
        return mistake;
    };
    const auto gain = [](MadeUp& day, const std::vector<Mistake>& further) {
        const Trial before(day.residuals({}, {}), day.list, {});
        return before.gain_of(
            Trial(day.residuals({further.begin(), further.end()}, {}), day.list, further), further);
    };
    CHECK(gain(real, {swap(3, 11)}) > 10.0);
    CHECK(gain(clean, {swap(3, 11), swap(11, 3)}) < 0.0);
}

TEST_CASE("in surveys without a mistake one is found as seldom as stated") {
    constexpr int kSurveys = 100;
    int found = 0;
    for (int seed = 1; seed <= kSurveys; ++seed)
        if (!MadeUp(static_cast<std::uint64_t>(1000 + seed)).search().empty()) ++found;
    WARN("found in " << found << " of " << kSurveys);
    // kMistakeAlpha and twice a tenth of it; the limit is exceeded by chance once in a thousand runs of other seeds.
    CHECK(found <= 8);
}

TEST_CASE("without a mistake the clearest one has any probability equally often") {
    const int surveys = a351::test::is_long() ? 300 : 60;
    int below_tenth = 0, below_half = 0;
    for (int seed = 1; seed <= surveys; ++seed) {
        MadeUp survey(static_cast<std::uint64_t>(2000 + seed));
        const judgement::Trial trial(survey.residuals({}, {}), survey.list, {});
        Mistake clearest = trial.best(1).front().mistake;
        trial.measure(clearest, 1.0);
        below_tenth += clearest.p < 0.1 ? 1 : 0;
        below_half += clearest.p < 0.5 ? 1 : 0;
    }
    WARN("p < 0.1 in " << below_tenth << ", p < 0.5 in " << below_half << " of " << surveys);
    // Three standard deviations.
    CHECK(std::abs(below_tenth - 0.1 * surveys) <= 3.0 * std::sqrt(0.09 * surveys));
    CHECK(std::abs(below_half - 0.5 * surveys) <= 3.0 * std::sqrt(0.25 * surveys));
}

TEST_CASE("a step next to an end of the day is a reading that is off") {
    MadeUp day(7);
    day.add(1, 18, 30.0);
    const auto found = day.search();
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == MistakeKind::stay);
    CHECK(found[0].readings == Numbers{0});
    CHECK(found[0].size_mgal < -20.0);
}

TEST_CASE("an unknown that is there twice takes one direction only") {
    Eigen::MatrixXd a(6, 3);
    for (Eigen::Index i = 0; i < 6; ++i) a.row(i) << 1.0, static_cast<double>(i), 1.0;
    const Eigen::MatrixXd basis = adjustment::orthonormal_basis(a);
    CHECK(basis.cols() == 2);
    CHECK((basis * (basis.transpose() * a) - a).norm() < 1e-12);
}

TEST_CASE("nothing is searched with too few readings, or without residuals") {
    MadeUp day(8);
    day.add(2, 3, 40.0);
    day.list.resize(5);
    day.errors_mgal.conservativeResize(5);
    CHECK(day.search().empty());
    struct Nothing final : adjustment::Trials {
        [[nodiscard]] std::shared_ptr<const adjustment::Residuals> residuals(
            const std::vector<adjustment::Alternative>&,
            const std::vector<adjustment::Alternative>&) override {
            return nullptr;
        }
    } nothing;
    CHECK(judgement::search_mistakes(readings(), nothing).empty());
    CHECK(judgement::search_mistakes({}, nothing).empty());
}
