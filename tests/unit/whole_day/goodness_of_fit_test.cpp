#include "corrector/whole_day/goodness_of_fit.hpp"

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

std::vector<FitTest> tests_of(const DayRecord& record,
                              const std::vector<DayStation>& stations = MadeUpDay::stations()) {
    const DayPriors priors = usual_day_priors();
    return goodness_of_fit({&record, stations, priors}, fit_day(record, stations).value());
}

/// Returns a made-up day to whose readings the function adds an effect, bin by bin.
template <class Effect>
DayRecord with_effect(std::uint64_t seed, const Effect& effect_mgal) {
    DayRecord record = kScattered.record(seed);
    for (DayBin& bin : record.bins) bin.reading = bin.reading + MilliGal(effect_mgal(bin));
    return record;
}

}  // namespace

TEST_CASE("ordinary days with five times the usual noise fit") {
    int misfits = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto tests =
            tests_of(MadeUpDay{.placement_mgal = 6.0, .white_mgal = 1.0}.record(seed));
        REQUIRE(tests.size() == 3);
        for (const FitTest& test : tests) misfits += test.is_misfit() ? 1 : 0;
    }
    CHECK(misfits <= 2);
}

TEST_CASE("a step is found where it is") {
    const auto tests =
        tests_of(with_effect(1, [](const DayBin& bin) { return bin.set_up >= 9 ? 15.0 : 0.0; }));
    const FitTest& step = tests.at(1);
    CHECK(step.misfit == Misfit::step);
    CHECK(step.is_misfit());
    CHECK(step.place == 9);
}

TEST_CASE("a response with the square of the temperature is found") {
    const DayRecord record = kScattered.record(2);
    const BinMeans means(record.temperature.series, record.bins);
    const Eigen::VectorXd degc = means.of(record.temperature.series.values());
    DayRecord bent = record;
    for (std::size_t i = 0; i < bent.bins.size(); ++i)
        bent.bins[i].reading =
            bent.bins[i].reading +
            MilliGal(150.0 * std::pow(degc(static_cast<Eigen::Index>(i)) - 42.5, 2));
    const FitTest curvature = tests_of(bent).front();
    CHECK(curvature.misfit == Misfit::curvature);
    CHECK(curvature.is_misfit());
    CHECK(curvature.place == 0);  // of the temperature, not of the time
}

TEST_CASE("set-ups that are far off are found") {
    const auto tests = tests_of(with_effect(3, [](const DayBin& bin) {
        return bin.set_up == 4 ? 14.0 : bin.set_up == 7 ? 15.0 : bin.set_up == 10 ? -17.0 : 0.0;
    }));
    CHECK(tests.at(2).misfit == Misfit::tails);
    CHECK(tests.at(2).is_misfit());
    CHECK(tests.at(2).place == 10);
}

TEST_CASE("the same day gives the same probabilities") {
    const DayRecord record = kScattered.record(4);
    const auto a = tests_of(record), b = tests_of(record);
    for (std::size_t k = 0; k < a.size(); ++k) CHECK(a[k].p == b[k].p);
}

TEST_CASE("a day with few known stations is not tested") {
    auto stations = stations_without({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});  // 16 set-ups at 11 sites
    CHECK(tests_of(kScattered.record(), stations).size() == 3);         // 5 degrees of freedom
    for (std::size_t s = MadeUpDay::kSites; s < MadeUpDay::kSetUps; ++s) stations[s].number = s;
    CHECK(tests_of(kScattered.record(), stations).empty());
}
