// Alternatives as updates of one factorisation, beside dense least squares with one more column each.
#include "corrector/adjustment/trials.hpp"

#include <array>
#include <random>

#include "tests/unit/adjustment/dense_oracle.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::adjustment;

namespace {

/// Two meters on a line with two known stations; each meter has two loops.
std::vector<reading::SurveyRow> line() {
    std::mt19937_64 generator(3);
    const auto noise_mgal = [&generator] {
        return 0.02 * (static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5);
    };
    const std::vector<std::pair<std::string, double>> sites{
        {"A", 0.0}, {"B", -60.0}, {"C", 35.0}, {"D", -97.0}};
    std::vector<reading::SurveyRow> rows;
    for (int loop = 1; loop <= 2; ++loop)
        for (const int place : {0, 1, 2, 3, 2, 1, 0}) {
            const auto& [site, gravity_mgal] = sites[static_cast<std::size_t>(place)];
            for (int meter = 0; meter < 2; ++meter) {
                reading::SurveyRow row;
                row.site = site;
                row.occupation = static_cast<int>(rows.size()) + 1;
                row.time = parse_rfc3339("2024-06-12T06:00:00Z").value() +
                           std::chrono::minutes(14 * std::ssize(rows) + meter);
                row.instrument = meter == 0 ? "M0" : "M1";
                row.loop = loop;
                row.has_temperature = false;
                if (place == 0 || place == 3) {
                    row.reference = MilliGal(980000.0 + gravity_mgal);
                    row.u_reference = MilliGal(0.01);
                }
                row.acceleration = MilliGal(4000.0 + gravity_mgal + noise_mgal());
                rows.push_back(row);
            }
        }
    return rows;
}

/// @param reading_sd_mgal  near the scatter of the readings, so that no other base is needed.
SurveyEquations survey_of(const std::vector<reading::SurveyRow>& rows,
                          double reading_sd_mgal = 0.005) {
    SurveyKnowledge knowledge;
    knowledge.priors.reading_sd_mgal = reading_sd_mgal;
    return {rows, std::vector<bool>(rows.size(), true),
            Design{"network", {&kConstant, &kTime, &kScaleTerm}, true, false}, knowledge};
}

/// Size and uncertainty of an offset of some readings, with further offsets free.
struct Offset {
    double size_mgal = 0.0, u_mgal = 0.0;
};

Offset dense_offset(const Equations& equations, const SurveyEquations& survey,
                    std::vector<Effect> free, const Effect& wanted) {
    free.push_back(wanted);
    const std::size_t unknowns = equations.stations + equations.terms;
    test::Matrix a(unknowns + free.size(), std::vector<test::Real>(equations.rows.size()));
    std::vector<test::Real> y(equations.rows.size());
    for (std::size_t i = 0; i < y.size(); ++i) {
        y[i] = static_cast<test::Real>(equations.rows[i].value) / equations.rows[i].sd;
        for (const auto& [unknown, factor] : equations.rows[i].unknowns)
            a[unknown][i] += static_cast<test::Real>(factor) / equations.rows[i].sd;
    }
    for (std::size_t k = 0; k < free.size(); ++k)
        for (const std::size_t reading : free[k]) {
            const std::size_t row = *survey.equation_of(reading);
            a[unknowns + k][row] = 1 / static_cast<test::Real>(equations.rows[row].sd);
        }
    const auto solution = test::solve_dense(std::move(a), y);
    return {static_cast<double>(solution.values.back()),
            static_cast<double>(std::sqrt(solution.cofactor.back().back()))};
}

Offset offset_of(const Residuals& residuals, const Effect& effect) {
    double sum = 0.0;
    for (const std::size_t i : effect)
        sum += residuals.seen().weighted(static_cast<Eigen::Index>(i));
    const double square = residuals.information(effect, effect);
    return {sum / square, 1.0 / std::sqrt(square)};
}

}  // namespace

TEST_CASE(
    "an alternative is an update: sizes are those of least squares with one more column each") {
    const auto rows = line();
    const double sd_mgal = 0.005 * adjust(survey_of(rows)).adjustment.s0().value();
    const AdjustedSurvey adjusted = adjust(survey_of(rows, sd_mgal));
    REQUIRE(adjusted.is_determined());
    const double noise = adjusted.adjustment.s0().value();
    REQUIRE(std::abs(noise - 1.0) < 0.05);
    const auto trials = white_trials(adjust(survey_of(rows, sd_mgal)));
    const Effect stay{4}, station{0, 1, 12, 13, 14, 15, 26, 27}, step{10, 12},
        wanted{8}, other{18, 20, 22, 24, 26};
    const std::vector<Alternative> known{{AlternativeKind::stay, stay, {}, 0.0},
                                         {AlternativeKind::station, station, {}, 0.0},
                                         {AlternativeKind::step, step, {}, 0.0}};
    for (const bool is_known : {false, true}) {
        const auto residuals =
            trials->residuals(is_known ? known : std::vector<Alternative>(), {});
        REQUIRE(residuals != nullptr);
        CHECK(residuals->dof() == Approx(static_cast<double>(adjusted.adjustment.dof()) -
                                         (is_known ? 3.0 : 0.0)));
        for (const Effect& effect : {wanted, other}) {
            const Offset ours = offset_of(*residuals, effect);
            const Offset dense = dense_offset(
                adjusted.adjustment.equations(), adjusted.survey,
                is_known ? std::vector<Effect>{stay, station, step} : std::vector<Effect>(), effect);
            CHECK(ours.size_mgal == Approx(dense.size_mgal).epsilon(1e-6).margin(1e-9));
            // The noise scales the readings, and priors and references with them.
            CHECK(ours.u_mgal == Approx(noise * dense.u_mgal).epsilon(1e-6));
        }
    }
}

TEST_CASE("the residuals with names put right are those of the survey with the right names") {
    const auto right = line();
    auto wrong = right;
    // Readings 0 (at A) and 6 (at D) under each other's name.
    for (const auto& [here, there] : {std::pair<std::size_t, std::size_t>{0, 6}, {6, 0}}) {
        wrong[here].site = right[there].site;
        wrong[here].reference = right[there].reference;
        wrong[here].u_reference = right[there].u_reference;
    }
    // The size is the reference of the other reading minus the own one.
    const Alternative swap{AlternativeKind::swap, {0}, {6}, 97.0};
    const auto of_right = white_trials(adjust(survey_of(right)))->residuals({}, {});
    const auto put_right = white_trials(adjust(survey_of(wrong)))->residuals({swap}, {swap});
    REQUIRE(of_right != nullptr);
    REQUIRE(put_right != nullptr);
    const Effect stay{8};
    const Offset ours = offset_of(*put_right, stay), expected = offset_of(*of_right, stay);
    CHECK(ours.size_mgal == Approx(expected.size_mgal).margin(0.5 * expected.u_mgal));
    CHECK(ours.u_mgal == Approx(expected.u_mgal).epsilon(0.3));
}

TEST_CASE(
    "a standard deviation that is stated wrongly is replaced by the scatter of the readings") {
    const auto rows = line();
    const double sd_mgal = 0.005 * adjust(survey_of(rows)).adjustment.s0().value();
    const AdjustedSurvey stated = adjust(survey_of(rows, sd_mgal));
    const Effect step{18, 20, 22, 24, 26};
    const Offset dense =
        dense_offset(stated.adjustment.equations(), stated.survey, {}, step);
    for (const double factor : {0.1, 10.0}) {
        const auto residuals =
            white_trials(adjust(survey_of(rows, factor * sd_mgal)))->residuals({}, {});
        const Offset ours = offset_of(*residuals, step);
        CHECK(ours.size_mgal == Approx(dense.size_mgal).margin(0.1 * dense.u_mgal));
        // A base is used for a noise within 5 % of its own.
        CHECK(ours.u_mgal == Approx(dense.u_mgal).epsilon(0.06));
    }
}

TEST_CASE("residuals that are drawn have the stated information") {
    const auto rows = line();
    const auto trials = white_trials(adjust(survey_of(rows)));
    const auto residuals = trials->residuals({}, {});
    std::mt19937_64 generator(5);
    const Effect effect{18, 20, 22, 24, 26};
    double squares = 0.0, scatter = 0.0;
    constexpr int kDraws = 4000;
    for (int draw = 0; draw < kDraws; ++draw) {
        const Seen seen = residuals->simulated(generator);
        double sum = 0.0;
        for (const std::size_t i : effect) sum += seen.weighted(static_cast<Eigen::Index>(i));
        squares += sum * sum;
        scatter += seen.square;
    }
    // Standard errors: 2.2 % of a variance, and sqrt(2 / dof) / sqrt(4000) of the scatter.
    CHECK(squares / kDraws == Approx(residuals->information(effect, effect)).epsilon(0.08));
    CHECK(scatter / kDraws == Approx(residuals->dof()).epsilon(0.03));
}

TEST_CASE("a pause of a day continues a gravimeter's loop, a night begins another one") {
    std::vector<reading::SurveyRow> rows(4);
    const std::array hours{0.0, 6.8, 7.0, 19.9};  // pauses of tests/golden: usgs and igp
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].time =
            parse_rfc3339("2024-06-12T06:00:00Z").value() + from_seconds(3600.0 * hours.at(i));
        rows[i].instrument = "CG-5 9379";
        rows[i].loop = 1;
    }
    CHECK(loop_numbers(rows) == std::vector<std::size_t>{0, 0, 0, 1});
    rows[2].loop = 2;
    CHECK(loop_numbers(rows) == std::vector<std::size_t>{0, 0, 1, 2});
}
