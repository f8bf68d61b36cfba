// Two real gravimeters against absolute gravity, from their raw files: tests/golden/usgs/README.md.
#include <fmt/core.h>
#include <cmath>
#include <iostream>
#include <map>
#include "tests/support/catch.hpp"

#include "corrector/gravimeter/survey_tables.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/model/network.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;

namespace {

/// Standard deviation of a reading, mGal.  Source: the manufacturer's repeatability of a Burris.
constexpr double kReadingSd_mgal = 0.005;

struct Survey {
    std::string name, month;
    std::vector<std::string> files;
};
const std::vector<Survey> kMeters{{"B44", "2017-12", {"B44_2017-12-05.txt"}},
                                  {"B44", "2018-02", {"B44_2018-02-27.txt"}},
                                  {"B108", "2017-12", {"B108_2017-12-05.txt"}}};
const Survey kBoth{"B44 and B108", "2017-12", {"B44_2017-12-05.txt", "B108_2017-12-05.txt"}};

struct Absolute {
    double gravity_mgal = 0.0;
    double u_mgal = 0.0;
};

std::map<std::string, Absolute> absolute_values(const std::string& month) {
    const auto table = text::read_csv(A351_GOLDEN "/usgs/absolute.csv");
    std::map<std::string, Absolute> values;
    for (std::size_t row = 0; row < table.row_count(); ++row)
        if (table.cell(row, "month") == month)
            values[table.cell(row, "site")] = {table.number(row, "gravity_mgal"),
                                               table.number(row, "u_gravity_mgal")};
    REQUIRE(values.size() == 4);
    return values;
}

/// Imports the raw files and reads the tables again, with the absolute values as references.
std::vector<reading::SurveyRow> rows_of(const Survey& survey, bool is_mean) {
    std::vector<gravimeter::GravimeterFile> files;
    for (const std::string& file : survey.files)
        files.push_back(gravimeter::read_gravimeter_file(A351_GOLDEN "/usgs/" + file));
    const auto stays = gravimeter::find_stays(files);
    gravimeter::TableOptions options;
    options.average.is_mean = is_mean;
    if (is_mean) options.average.last = 0;
    const test::TemporaryDirectory folder;
    text::write_together(folder.path(), gravimeter::survey_tables(files, stays, options));
    auto sites = text::read_sites(folder.path() / "sites.csv");
    for (const auto& [name, value] : absolute_values(survey.month)) {
        for (text::Site& site : sites) {
            if (site.name != name) continue;
            site.gravity = MilliGal(value.gravity_mgal);
            site.u_gravity = MilliGal(value.u_mgal);
        }
    }
    auto rows = reading::read_observations(folder.path() / "observations.csv", sites);
    tide::apply_tide(rows, sites, {"given", {}, {}});
    return rows;
}

struct HoldOut {
    double error_mgal = 0.0;  ///< Prediction minus absolute value.
    double u_mgal = 0.0;      ///< Standard uncertainty of the prediction.
    /// Returns the error in units of its uncertainty, that of the absolute value included.
    [[nodiscard]] double ratio(const Absolute& value) const {
        return std::abs(error_mgal) / std::hypot(u_mgal, value.u_mgal);
    }
};

/// Adjusts a network and compares a station with a value.
HoldOut value_of(const std::vector<reading::SurveyRow>& rows, const std::string& site,
                 const std::vector<std::string>& datum, const adjustment::Priors& priors,
                 const model::NetworkOptions& options, double gravity_mgal) {
    const auto network =
        model::adjust_network(rows, std::vector<bool>(rows.size(), true),
                              {.datum = datum, .network = options, .priors = priors})
            .adjusted.value();
    const auto& stations = network.survey.stations();
    const auto at = static_cast<std::size_t>(
        std::ranges::find(stations, site, &adjustment::EquationStation::site) - stations.begin());
    return {network.gravity(at).value() - gravity_mgal,
            std::sqrt(network.adjustment.variance({{at, 1.0}}))};
}

/// Predicts one absolute station from the others.
HoldOut hold_out(const std::vector<reading::SurveyRow>& rows, const std::string& held,
                 const Absolute& value, int degree) {
    std::vector<std::string> datum;
    for (const reading::SurveyRow& row : rows)
        if (row.reference && row.site != held) datum.push_back(row.site);
    adjustment::Priors priors;
    priors.reading_sd_mgal = kReadingSd_mgal;
    model::NetworkOptions options;
    options.drift_degree = degree;
    return value_of(rows, held, datum, priors, options, value.gravity_mgal);
}

/// Predicts all absolute stations, prints the errors and returns them by station.
std::map<std::string, HoldOut> hold_out_all(const Survey& survey, bool is_mean, int degree) {
    const auto rows = rows_of(survey, is_mean);
    std::map<std::string, HoldOut> errors;
    std::cout << fmt::format("{} {} {} degree {}:", survey.name, survey.month,
                             is_mean ? "mean of all" : "median of 8", degree);
    for (const auto& [site, value] : absolute_values(survey.month)) {
        errors[site] = hold_out(rows, site, value, degree);
        std::cout << fmt::format("  {} {:+.4f} ({:.4f})", site, errors[site].error_mgal,
                                 errors[site].u_mgal);
    }
    std::cout << '\n';
    return errors;
}

double rms(const std::map<std::string, HoldOut>& errors) {
    double squares = 0.0;
    for (const auto& [site, one] : errors) squares += one.error_mgal * one.error_mgal;
    return std::sqrt(squares / static_cast<double>(errors.size()));
}

}  // namespace

TEST_CASE("absolute stations that are held out agree within their uncertainty") {
    std::vector<double> ratios;
    for (const bool is_mean : {false, true}) {
        for (const int degree : {1, 2}) {
            double squares = 0.0;
            for (const Survey& meter : kMeters) {
                const auto absolute = absolute_values(meter.month);
                const auto errors = hold_out_all(meter, is_mean, degree);
                for (const auto& [site, one] : errors)
                    ratios.push_back(one.ratio(absolute.at(site)));
                squares += std::pow(rms(errors), 2) / static_cast<double>(kMeters.size());
            }
            std::cout << fmt::format("rms of 12 hold-outs {:.4f} mGal, must be at most 0.010\n",
                                     std::sqrt(squares));
            CHECK(std::sqrt(squares) <= 0.010);
        }
    }
    REQUIRE(ratios.size() == 48);
    const auto share = [&](double limit) {
        return static_cast<double>(
                   std::ranges::count_if(ratios, [&](double one) { return one <= limit; })) /
               static_cast<double>(ratios.size());
    };
    std::cout << fmt::format(
        "of 48: {:.1f} % within 2 u, must be at least 92; {:.1f} % within u, must be 60 to 80\n",
        100.0 * share(2.0), 100.0 * share(1.0));
    CHECK(share(2.0) >= 0.92);
    CHECK(share(1.0) >= 0.60);
    CHECK(share(1.0) <= 0.80);
}

TEST_CASE(
    "two gravimeters together predict no worse than the worse of them, and more surely than each") {
    for (const bool is_mean : {false, true}) {
        for (const int degree : {1, 2, 3}) {
            const auto first = hold_out_all(kMeters[0], is_mean, degree);
            const auto second = hold_out_all(kMeters[2], is_mean, degree);
            const auto both = hold_out_all(kBoth, is_mean, degree);
            std::cout << fmt::format("rms {:.4f} and {:.4f}, together {:.4f} mGal\n", rms(first),
                                     rms(second), rms(both));
            // A cubic drift brings each of them below 0.005 mGal, half the uncertainty of the
            // absolute values, so that their order says nothing.
            CHECK(rms(both) <= (degree == 3 ? 0.006 : std::max(rms(first), rms(second))));
            for (const auto& [site, one] : both) {
                CHECK(one.u_mgal <= first.at(site).u_mgal);
                CHECK(one.u_mgal <= second.at(site).u_mgal);
            }
        }
    }
}

TEST_CASE("the far end of a line of 198 mGal is off by the meter's scale, and u says so") {
    // The real readings of a meter, with a made-up part: one real station, rg57, is moved 198 mGal away.
    // The made-up error of the meter's scale is 0.036 mGal in 198 mGal.
    constexpr double kRange_mgal = 198.0, kScale = 1.0 + 0.036 / kRange_mgal;
    auto rows = rows_of(kMeters[0], false);
    const auto is_far = [](const reading::SurveyRow& row) { return row.site == "rg57"; };
    for (reading::SurveyRow& row : rows) {
        if (!is_far(row)) continue;
        row.acceleration = row.acceleration + MilliGal(kScale * kRange_mgal);
        row.reference = *row.reference + MilliGal(kRange_mgal);
    }
    const double reference = std::ranges::find_if(rows, is_far)->reference->value();
    const auto far_end = [&](adjustment::Prior scale) {
        adjustment::Priors priors;
        priors.reading_sd_mgal = kReadingSd_mgal;
        adjustment::set_prior(priors, "test", "scale", scale);
        const HoldOut end = value_of(rows, "rg57", {"rg37"}, priors, {}, reference);
        std::cout << fmt::format("far end off by {:+.4f} mGal, u {:.4f}\n", end.error_mgal,
                                 end.u_mgal);
        return end;
    };
    const HoldOut held = far_end(adjustment::Prior{1.0, 1e-6}), free = far_end(adjustment::Prior{1.0, 1e-4});
    const Absolute value{reference, absolute_values("2017-12").at("rg57").u_mgal};
    CHECK(held.u_mgal < 0.013);
    CHECK(free.u_mgal == Approx(std::hypot(held.u_mgal, 1e-4 * kRange_mgal)).epsilon(0.01));
    CHECK(far_end(adjustment::kGravimeterScale).u_mgal == Approx(0.0998).margin(0.0001));
    CHECK(free.ratio(value) < 2.0);
    CHECK(free.error_mgal == Approx(held.error_mgal).epsilon(0.01));
}

TEST_CASE("a finding about a gravimeter has a size that can be read") {
    auto rows = rows_of(kMeters[2], false);
    constexpr double kStep_mgal = 0.0623;
    for (reading::SurveyRow& row : rows)
        if (row.time > rows[8].time) row.acceleration = row.acceleration + MilliGal(kStep_mgal);
    model::SurveyOptions options;
    options.priors.reading_sd_mgal = kReadingSd_mgal;
    const auto result = judgement::correct_and_search({rows, {}, nullptr}, options);
    REQUIRE(!result.findings.empty());
    for (const reading::Finding& finding : result.findings) std::cout << finding.text.english() << '\n';
    CHECK(result.findings[0].kind == reading::FindingKind::step);
    CHECK_THAT(result.findings[0].text.english(),
               ContainsSubstring("the readings are 0.06") && !ContainsSubstring("0.0 +- 0.0"));
    // A drift cannot explain what was known before the search.
    const std::vector<reading::Finding> known(
        3, {.kind = reading::FindingKind::bad_reading, .code = "never_at_rest", .text = "x"});
    const auto with_known = judgement::correct_and_search({rows, {}, nullptr}, options, known);
    CHECK(with_known.findings.size() == result.findings.size() + known.size());
}

TEST_CASE("it is said how many mistakes are found with a curved drift") {
    const auto curved = [](const Survey& survey, int degree, bool has_short_loop = false) {
        model::SurveyOptions options;
        options.priors.reading_sd_mgal = kReadingSd_mgal;
        options.network.drift_degree = degree;
        auto rows = rows_of(survey, false);
        for (const std::size_t i : {std::size_t{0}, std::size_t{5}}) {
            if (!has_short_loop) break;
            rows.push_back(rows[i]);
            rows.back().instrument = "of two readings";
        }
        std::ranges::stable_sort(rows, {}, &reading::SurveyRow::time);
        std::vector<std::string> texts;
        for (const auto& finding : judgement::correct_and_search({rows, {}, nullptr}, options).findings)
            if (finding.code == "misfit_drift") texts.push_back(finding.text.english());
        return texts;
    };
    CHECK(curved(kBoth, 1) ==
          std::vector<std::string>{
              "with a drift of degree 3 in each loop the number of mistakes is 1 instead of 6; s0 is "
              "then 1.01, and 0.59 with the mistakes put right: the drift may be curved"});
    CHECK(curved(kBoth, 3).empty());
    CHECK(curved(kMeters[2], 1).empty());
    CHECK(curved(kBoth, 1, true).empty());  // Two readings do not determine a curve.
}

TEST_CASE("the table of absolute values comes from the files of the absolute gravimeter") {
    // The value at the mark: that at the transfer height of 100 cm plus 3 uGal/cm.
    const std::map<std::string, std::string> suffixes{{"2017-12", "_2017-12-01.project.txt"},
                                                      {"2018-02", "_2018-02-2"}};
    for (const auto& [month, suffix] : suffixes) {
        for (const auto& [site, value] : absolute_values(month)) {
            const std::string day =
                month == "2017-12" ? "" : (site == "rg57" ? "8.project.txt" : "6.project.txt");
            const std::string report =
                text::read_text_file(A351_GOLDEN "/usgs/" + site + suffix + day);
            const auto number_after = [&](const std::string& key) {
                return std::stod(report.substr(report.find(key) + key.size()));
            };
            INFO(site << " " << month);
            CHECK(number_after("\nTransfer Height: ") == 100.0);
            CHECK((number_after("\nGravity: ") + 300.0) / 1000.0 ==
                  Approx(value.gravity_mgal).epsilon(0).margin(0.00005));
            // One uncertainty for all; the reports have 0.01055 to 0.01075 mGal.
            CHECK(number_after("\nTotal Uncertainty: ") / 1000.0 ==
                  Approx(value.u_mgal).epsilon(0).margin(0.0002));
        }
    }
}
