#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <random>
#include "tests/support/catch.hpp"

#include "corrector/report/report.hpp"

using namespace a351;
using namespace a351::corrector::long_record;
using namespace a351::corrector::report;

namespace {

/// Returns a night in which the acceleration is the rate of change of a cycle, with noise.
RecordResult night(bool is_raw) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    RecordStretch stretch;
    for (int i = 0; i < 1080; ++i) {
        const double phase = 2.0 * M_PI * 20.0 * i / 900.0;
        stretch.times.push_back(UtcTime(from_seconds(20.0 * i)));
        stretch.temperature_degc.push_back(42.5 + 0.01 * std::sin(phase) + 1e-3 * normal(random));
        stretch.quantity.push_back(979763.0 + 2.5 * std::cos(phase) + 0.5 * normal(random));
        if (is_raw) stretch.raw.push_back({979700.0, 979800.0, 42.4, 42.6});
    }
    RecordResult result;
    result.record.stretches.push_back(std::move(stretch));
    result.record.warnings = {"<B> is left out"};
    result.parts = divide_record(result.record);
    result.options.ensemble_size = 4;
    result.analysis = analyse_record(result.segment(), kRecordStep_s, result.options);
    return result;
}

}  // namespace

TEST_CASE("the page of a long record is well-formed and has the publication's figures") {
    for (const bool is_raw : {true, false}) {
        const RecordResult result = night(is_raw);
        const Report page = make_long_record_page(result, {{"command", "record"}}, {});
        CHECK(page.warnings.empty());
        CHECK(page.files.front().first == "record.html");
        const std::string& html = page.files.front().second;
        pugi::xml_document document;
        CHECK(document.load_string(html.c_str()));
        // Figures: raw and at 20 s, trend, decomposition, modes, their scatter and correlation, all
        // samples, response, two of the noise.
        CHECK(document.select_nodes("//*[local-name()='svg']").size() == (is_raw ? 12U : 11U));
        CHECK_THAT(html, ContainsSubstring("rate of change") && ContainsSubstring("by spectrum") &&
                             ContainsSubstring("&lt;B&gt; is left out") &&
                             !ContainsSubstring("This figure is missing"));
    }
}
