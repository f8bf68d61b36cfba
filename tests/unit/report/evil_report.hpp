#pragma once
/// @file
/// A report with names that are HTML, for tests.

#include <nlohmann/json.hpp>

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/report.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/model/survey_rows.hpp"

namespace a351::corrector::report {

inline const std::string kEvil = "<script>&'\"`x`\xFF";

inline model::SurveyCorrection result_with_evil_name() {
    auto rows = model::made_up::day();
    rows[3].site = kEvil;
    rows[3].notes = {"</td>" + kEvil};
    model::add(rows[3], 1.0);
    return model::correct_survey(rows, {.model = "t-rate-drift"});
}

inline ReportSources sources() {
    ReportSources sources;
    sources.title = "day & night " + kEvil;
    sources.sites = {{kEvil, Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979800.0)}};
    sources.inputs = {{"sites", "<sites>.csv", 12, 0x00ABCDEF}};
    sources.warnings = {"<B> is left out"};
    return sources;
}

inline Report report() {
    nlohmann::ordered_json settings;
    settings["model"] = "<auto>";
    settings["datum"] = {kEvil};
    settings["warnings"] = {"not twice"};
    return make_report(result_with_evil_name(), settings, sources());
}

inline const std::string& file(const Report& report, const std::string& name) {
    for (const auto& [file_name, content] : report.files)
        if (file_name == name) return content;
    FAIL(name + " is missing");
    return report.files.front().second;
}

}  // namespace a351::corrector::report
