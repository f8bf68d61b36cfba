#include "corrector/model/model.hpp"

#include <set>

#include "corrector/model/linear_models.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "tests/unit/model/corrections.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

RowChoice all_of(const std::vector<SurveyRow>& rows) {
    const std::vector<bool> all(rows.size(), true);
    return {all, all};
}

bool needs_records(const Model& model) {
    return model.name == kWholeDay || model.name == "t-rate-drift-axes";
}

SurveyOptions options_for(const std::vector<SurveyRow>& rows) {
    return {.base = rows.front().site};
}

}  // namespace

TEST_CASE("every model has a name of its own, by which it is found") {
    std::set<std::string_view> names{kAutomatic};
    for (const Model& model : models()) {
        CHECK(names.insert(model.name).second);
        CHECK(find_model(model.name) == &model);
    }
    CHECK(names.size() == model_names().size());
    CHECK(find_model("kriging") == nullptr);
    CHECK(find_model(kAutomatic) == nullptr);
}

TEST_CASE("every model of averages gives rows whose corrections add up to the corrected value") {
    auto rows = made_up::day();
    add(rows[2], 1.5);
    const SurveyOptions options = options_for(rows);
    const SurveyProblem problem{rows, options, nullptr};
    for (const Model& model : models()) {
        CAPTURE(model.name);
        if (needs_records(model)) continue;
        const auto fit = std::get<model::Fit>(model.fit(problem, all_of(rows)));
        REQUIRE(fit.rows.size() == rows.size());
        for (const CorrectedRow& row : fit.rows) {
            CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(0).margin(1e-8));
        }
        CHECK(fit.score.model == model.name);
        CHECK(fit.stations.size() == station_names(rows).size());
        CHECK((fit.rows.front().as<PaperRow>() != nullptr) == (model.name == kPaper));
        CHECK((fit.as<NetworkPart>() != nullptr) == (model.name == "network"));
    }
}

TEST_CASE("a linear model corrects for its own terms only") {
    const auto rows = made_up::day();
    const SurveyOptions options = options_for(rows);
    const SurveyProblem problem{rows, options, nullptr};
    for (const char* const name : {"t", "t-rate", "t-drift", "t-rate-drift", "drift"}) {
        CAPTURE(name);
        const auto has_term = [&](const adjustment::Term& term) {
            const auto& terms = find_linear_model(name)->terms;
            return std::ranges::find(terms, &term) != terms.end();
        };
        const auto fit = std::get<model::Fit>(find_model(name)->fit(problem, all_of(rows)));
        const auto has_correction = [&](MilliGal CorrectedRow::*correction) {
            return std::ranges::any_of(fit.rows, [&](const CorrectedRow& row) {
                return std::abs((row.*correction).value()) > 1e-9;
            });
        };
        CHECK(has_correction(&CorrectedRow::rate_correction) == has_term(adjustment::kRate));
        CHECK(has_correction(&CorrectedRow::drift_correction) == has_term(adjustment::kTime));
        CHECK_FALSE(fit.rows.front().tilt_correction);
        CHECK_FALSE(fit.rows.front().scale_correction);
    }
}

TEST_CASE("every model refuses a survey without a reference, and says what would help") {
    auto rows = made_up::day();
    for (SurveyRow& row : rows) row.reference.reset();
    const SurveyOptions options = options_for(rows);
    const RowChoice none{std::vector<bool>(rows.size(), true),
                         std::vector<bool>(rows.size(), false)};
    for (const Model& model : models()) {
        CAPTURE(model.name);
        if (model.name == "t-rate-drift-axes") continue;  // InputError: a row without axes
        const auto fit = model.fit({rows, options, nullptr}, none);
        const Refusal& refusal = std::get<Refusal>(fit);
        CHECK_FALSE(refusal.trouble.empty());
        CHECK_FALSE(refusal.allowed.empty());
        const auto score = model.score({rows, options, nullptr}, none);
        CHECK_FALSE((score && score->rms_mgal));
    }
}

TEST_CASE("the whole-day model refuses priors that it would ignore") {
    const auto rows = made_up::day();
    SurveyOptions options = options_for(rows);
    set_prior(options.priors, "test", "time_mgal_per_h", {0.0, 0.1});
    DayRecord day{{{rows.front().time, Hertz(0.5), {42.5}}, {}}, {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        DayBin& bin = day.bins.emplace_back();
        bin.set_up = i;
    }
    const auto fit = find_model("day")->fit({rows, options, &day}, all_of(rows));
    CHECK_THAT(std::get<Refusal>(fit).trouble, ContainsSubstring("`prior` would be ignored"));
}

TEST_CASE("the publication's Error (1) is given only with a reference") {
    auto rows = made_up::day();
    rows[4].reference.reset();
    const SurveyOptions options = options_for(rows);
    RowChoice choice = all_of(rows);
    choice.in_use[4] = false;
    const auto fit = std::get<model::Fit>(paper_model().fit({rows, options, nullptr}, choice));
    CHECK_FALSE(fit.rows[4].as<PaperRow>()->residual1);
    const PaperRow& known = *fit.rows[3].as<PaperRow>();
    CHECK(known.residual1->value() ==
          Approx((known.corrected1 - *rows[3].reference).value()).margin(1e-9));
}

TEST_CASE("a model without a scale says that it does not use the prior of the scale") {
    const auto rows = made_up::day();
    SurveyOptions options = options_for(rows);
    set_prior(options.priors, "test", "scale", {1.0, 0.002});
    for (const std::string name : {"paper", "network", "t-rate-drift"}) {
        options.model = name;
        const std::string remark = text::in_words(correct_survey(rows, options).remarks, "; ");
        CHECK((remark.find("does not use: prior scale") != std::string::npos) == (name == "paper"));
    }
}

TEST_CASE("a linear model with a prior of the scale finds a station whose gravity is far away") {
    constexpr double kScaleError = 0.01, kFar_mgal = 500.0, kPriorSd = 0.001;
    auto rows = made_up::day();
    SurveyRow& far = rows[8];  // S7, once
    const MilliGal truth = *far.reference + MilliGal(kFar_mgal);
    add(far, kFar_mgal);
    for (SurveyRow& row : rows)
        add(row, kScaleError * ((&row == &far ? truth : *row.reference).value() -
                                kMilliGalPerStandardGravity));
    far.reference.reset();
    for (std::size_t i = 0; i < rows.size(); ++i)  // scatter, so that there is a standard error
        add(rows[i], i % 2 == 0 ? 0.01 : -0.01);
    SurveyOptions options = options_for(rows);
    options.model = "t-rate-drift";
    const auto without = correct_survey(rows, options);
    CHECK(without.scales.empty());
    CHECK((station(without, "S7").gravity - truth).value() > 1.0);

    set_prior(options.priors, "test", adjustment::kScale, {1.0 + kScaleError, kPriorSd});
    const auto with = correct_survey(rows, options);
    REQUIRE(with.scales.size() == 1);
    CHECK(with.scales[0].value == Approx(1.0 + kScaleError).epsilon(0).margin(1e-4));
    CHECK((station(with, "S7").gravity - truth).value() == Approx(0.0).margin(0.1));
    CHECK(with.coefficients.back().name == adjustment::kScale);
    CHECK(with.coefficients.back().value == with.scales[0].value);
    for (const CorrectedRow& row : with.rows) {
        CHECK(row.scale_correction);
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).margin(1e-6));
    }

    // The far station's error is mostly that of the scale.
    options.priors.reading_sd_mgal = 0.01;
    set_prior(options.priors, "test", adjustment::kScale, {1.0 + kScaleError, 1e-6});
    const double held = station(correct_survey(rows, options), "S7").u_gravity.value().value();
    set_prior(options.priors, "test", adjustment::kScale, {1.0 + kScaleError, kPriorSd});
    const double loose = station(correct_survey(rows, options), "S7").u_gravity.value().value();
    CHECK(loose > 2.0 * held);
}
