// A real campaign of two gravimeters beside the solution published with it: tests/golden/igp/README.md.
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include "tests/support/catch.hpp"

#include "corrector/gravimeter/gravimeter_file.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/judgement/unlike_neighbours.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/text/doubtful_site.hpp"

using namespace a351;
using namespace a351::corrector;

namespace {

/// Scatter of a reading of these meters on the road, mGal.
constexpr double kReadingSd_mgal = 0.011;
/// Absolute stations, mGal above one constant, with u 0.005.
const std::map<std::string, double> kAbsolute{
    {"11014121", 1110.54453}, {"13072402", 961.0019}, {"10114700", 868.0904}};
constexpr double kConstant_mgal = 979000.0;

std::vector<std::vector<std::string>> words_of(const std::string& file) {
    std::ifstream in(A351_GOLDEN "/igp/" + file);
    REQUIRE(in);
    std::vector<std::vector<std::string>> lines;
    for (std::string line; std::getline(in, line);) {
        std::istringstream text(line);
        std::vector<std::string> words;
        for (std::string word; text >> word;) words.push_back(word);
        lines.push_back(std::move(words));
    }
    return lines;
}

std::vector<text::Site> sites() {
    std::vector<text::Site> list;
    for (const std::string file : {"QSCW912018.DZJ", "SDQSX8.DZJ"})
        for (const auto& words : words_of(file)) {
            if (words.size() < 5 || text::find_site(list, words[0]) != nullptr) continue;
            const std::size_t last = words.size() - 1;
            list.push_back({words[0], Degrees(std::stod(words[last - 1])),
                            Degrees(std::stod(words[last - 2])), Metres(std::stod(words[last])),
                            std::nullopt});
        }
    return list;
}

/// Scales of the published solution.
const std::map<std::string, double> kScales{{"QSCW201508p.098", 1.00009},
                                            {"QSCW201508p.099", 1.000637}};

/// Returns the readings, multiplied by these scales, and the references of `held`.
std::vector<reading::SurveyRow> rows(const std::vector<std::string>& held,
                                     const std::map<std::string, double>& scales = kScales) {
    std::vector<reading::SurveyRow> list;
    for (const auto& [file, scale] : scales) {
        const auto readings =
            gravimeter::read_gravimeter_file(A351_GOLDEN "/igp/" + file, {std::chrono::hours(8)})
                .readings;
        for (const gravimeter::Reading& reading : readings) {
            reading::SurveyRow row;
            row.time = reading.time;
            row.instrument = reading.instrument;
            row.loop = reading.loop;
            row.site = reading.site;
            row.acceleration = MilliGal(scale * reading.value.value());
            row.has_temperature = false;
            if (std::ranges::find(held, row.site) != held.end()) {
                row.reference = MilliGal(kConstant_mgal + kAbsolute.at(row.site));
                row.u_reference = MilliGal(0.005);
            }
            list.push_back(std::move(row));
        }
    }
    std::ranges::stable_sort(list, {}, &reading::SurveyRow::time);
    std::map<std::string, int> stays;
    for (reading::SurveyRow& row : list) row.occupation = ++stays[row.site];
    tide::apply_tide(list, sites(), {"direct", {}, {}});
    return list;
}

model::SurveyCorrection corrected(const std::vector<std::string>& held) {
    model::SurveyOptions options;
    options.priors.reading_sd_mgal = kReadingSd_mgal;
    return judgement::correct_and_search({rows(held), {}, nullptr}, options);
}

const model::StationValue& station(const model::SurveyCorrection& result, const std::string& site) {
    return *std::ranges::find(result.stations, site, &model::StationValue::site);
}

}  // namespace

TEST_CASE("a campaign of 112 stations agrees with the solution published with it") {
    const auto result = corrected({"11014121"});
    REQUIRE(result.rows.size() == 548);
    REQUIRE(result.stations.size() == 112);
    const auto* const network = result.as<model::NetworkPart>();
    REQUIRE(network != nullptr);
    CHECK(network->passes_global_test().value());
    CHECK(network->s0().value() == Approx(0.98).margin(0.01));

    auto places = sites();
    CHECK(judgement::unlike_neighbours(result, places).empty());
    auto& lowered = *std::ranges::find(places, "11002800", &text::Site::name);
    lowered.altitude = lowered.altitude - Metres(200.0);
    const auto unlike = judgement::unlike_neighbours(result, places);
    REQUIRE(unlike.size() == 1);
    CHECK(unlike[0].site == lowered.name);

    std::ifstream in(A351_GOLDEN "/igp/grav_baj.txt");
    const auto published = nlohmann::json::parse(in);
    std::map<std::string, double> theirs;
    for (std::size_t k = 0; k < published["staid"].size(); ++k)
        theirs[published["staid"][k]] = published["gvalue_mGal"][k];
    const double ours_at_base = station(result, "11014121").gravity.value();
    double squares = 0.0;
    for (const model::StationValue& one : result.stations)
        squares += std::pow(
            (one.gravity.value() - ours_at_base) - (theirs.at(one.site) - theirs.at("11014121")),
            2);
    const double rms_mgal = std::sqrt(squares / static_cast<double>(result.stations.size()));
    std::cout << fmt::format("{:.4f} mGal rms from the published solution\n", rms_mgal);
    CHECK(rms_mgal < 0.0195);

    for (const std::string hidden : {"13072402", "10114700"}) {
        const model::StationValue& one = station(result, hidden);
        const double error_mgal = one.gravity.value() - kConstant_mgal - kAbsolute.at(hidden);
        std::cout << fmt::format("hidden {} {:+.4f} ({:.4f})\n", hidden, error_mgal,
                                 one.u_gravity->value());
        CHECK(std::abs(error_mgal) < 2.0 * one.u_gravity->value());
    }
}

TEST_CASE("the scales of the two meters come out as published, with the usual prior") {
    model::SurveyOptions options;
    options.priors.reading_sd_mgal = kReadingSd_mgal;
    const auto result =
        judgement::correct_and_search({rows({"11014121", "13072402", "10114700"},
                                            {{"QSCW201508p.098", 1.0}, {"QSCW201508p.099", 1.0}}),
                                       {},
                                       nullptr},
                                      options);
    REQUIRE(result.scales.size() == 2);
    for (const model::ScaleEstimate& scale : result.scales) {
        const double published = 1.0 / kScales.at("QSCW201508p." + scale.instrument.substr(1));
        std::cout << fmt::format("{}: {:.5f} +- {:.5f}, published {:.5f}\n", scale.instrument,
                                 scale.value, scale.u, published);
        CHECK(std::abs(scale.value - published) < 2.0 * scale.u);
    }
    CHECK(std::ranges::none_of(result.findings, [](const reading::Finding& finding) {
        return finding.kind == reading::FindingKind::scale;
    }));
    CHECK(result.score.loso_mgal.value() < 0.05);
}

TEST_CASE("none of the sites of a real campaign is doubtful") {
    const auto list = sites();
    REQUIRE(list.size() == 418);
    CHECK(text::doubtful_site(list).empty());
}

TEST_CASE("mistakes of a real campaign are few, large enough to be read, and each named once") {
    const auto result = corrected({"11014121"});
    std::vector<std::string> texts;
    for (const reading::Finding& finding : result.findings) {
        if (reading::is_remark(finding)) continue;
        texts.push_back(finding.text.english());
        std::cout << texts.back() << '\n';
        if (finding.size_mgal && finding.u_mgal)
            CHECK(std::abs(*finding.size_mgal) >= 3.0 * *finding.u_mgal);
        CHECK(std::ranges::count(texts, texts.back()) == 1);
    }
    CHECK(texts.size() <= 4);  // of 548 readings
}

TEST_CASE("a reading of a real campaign that is made wrong by 0.3 mGal is named") {
    auto list = rows({"11014121"});
    reading::SurveyRow& wrong = list[100];
    wrong.acceleration = wrong.acceleration + MilliGal(0.3);
    const std::string site = wrong.site;
    const int occupation = wrong.occupation;
    model::SurveyOptions options;
    options.priors.reading_sd_mgal = kReadingSd_mgal;
    const auto findings = judgement::correct_and_search({list, {}, nullptr}, options).findings;
    const auto named = std::ranges::find_if(findings, [&](const reading::Finding& finding) {
        return finding.site == site && finding.occupation == occupation;
    });
    REQUIRE(named != findings.end());
    CHECK(std::abs(*named->size_mgal - 0.3) < 4.0 * *named->u_mgal);
}
