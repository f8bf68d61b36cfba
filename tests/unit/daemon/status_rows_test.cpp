#include "daemon/page/status_rows.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>

#include "daemon/page/status_fields.hpp"
#include "daemon/page/status_json.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

namespace {

/// Returns the text of a row in GET /api/rows; "(no row)" if there is none.
std::string row_of(Page& page, const std::string& label) {
    const json answer = page.ask(get("/api/rows"));
    for (const json& row : answer["rows"])
        if (row["label"] == label) return row["text"];
    return "(no row)";
}

/// Returns true if a row has these neighbouring values; others may be added.
bool has(Page& page, const std::string& label, const std::string& values) {
    const std::string text = row_of(page, label);
    UNSCOPED_INFO(label << ": " << text);
    return (", " + text + ", ").find(", " + values + ", ") != std::string::npos;
}

/// Returns a status in which every field and every key is there.
json full_status() {
    Page page;
    fill(page.status);
    page.status.warn("disk nearly full");
    page.status.clock_step = {minute(1), minute(2)};
    page.status.verdict.reasons = {{.quantity = "noise", .value = 6.0, .limit = 5.0}};
    page.occupations.start("No.1", {}, minute(50));
    auto field = survey::field_status(page.occupations, page.live, page.status.now);
    field.reading = field.whole;
    field.moved = {minute(51), false};
    field.warnings = {"the box was moved"};
    field.level.emplace().advice = {"lower the +x side"};
    field.level_site = "No.0";
    const Judgement judgement = judged(page.status, std::chrono::seconds(3));
    const survey::SoFar so_far;
    const survey::Signal signal =
        survey::signal_of({verdict::State::stable, {}, {}}, {}, field.stay, "",
                          {{"reference", "K", "No.1 is off", {survey::kChecked}}});
    return to_json({page.status, page.occupations, field, page.live, judgement, signal, so_far});
}

/// Returns the meaning of a field and, if it names a section of the manual page, this section.
std::string explanation_of(const Field& field) {
    const std::string meaning(field.meaning);
    std::smatch section;
    if (!std::regex_search(meaning, section, std::regex("see ([A-Z ]+)[.;]"))) return meaning;
    static const std::string kPage =
        text::read_text_file(std::filesystem::path(A351_GOLDEN) / "../../daemon/page/a351d-http.7");
    const auto begin = kPage.find("\n.SH " + section[1].str() + "\n");
    REQUIRE(begin != std::string::npos);
    return meaning + kPage.substr(begin, kPage.find("\n.SH ", begin + 1) - begin);
}

/// Returns true if a path is a field, or if the field above it explains the keys in between.
bool is_explained(json::json_pointer path) {
    std::vector<std::string> keys;
    for (; !path.empty(); path.pop_back()) {
        const auto field = std::ranges::find(status_fields(), path.to_string(), &Field::path);
        if (field != status_fields().end()) {
            return std::ranges::all_of(keys, [&](const std::string& key) {
                return std::regex_search(explanation_of(*field), std::regex("\\b" + key + "\\b"));
            });
        }
        // An index of a list needs no explanation.
        if (path.back().find_first_not_of("0123456789") != std::string::npos)
            keys.push_back(path.back());
    }
    return false;
}

}  // namespace

TEST_CASE("each field is declared once, is in the status, and has its metric and its row") {
    const json status = full_status();
    const std::string metrics = metrics_of(status, {});
    const std::vector<Row> rows = recorder_rows(status);
    const auto has_sample = [&](const Metric& metric) {
        std::string begin = '\n' + metric.name + (metric.key.empty() ? " " : "{");
        if (!metric.label.empty())
            begin += std::string(metric.key) + "=\"" + std::string(metric.label) + '"';
        return metrics.find(begin) != std::string::npos;
    };
    std::set<std::string> paths;
    for (const Field& field : status_fields()) {
        CAPTURE(field.path);
        CHECK(paths.insert(field.path).second);
        CHECK(field.meaning.ends_with('.'));
        CHECK(status.contains(json::json_pointer(field.path)));
        if (!field.metric.name.empty()) CHECK(has_sample(field.metric));
        if (!field.shown.row.empty())
            CHECK(std::ranges::count(rows, field.shown.row, &Row::label) == 1);
    }
}

TEST_CASE("each key of the status is a field, or the field above it explains it") {
    const json leaves = full_status().flatten();
    for (const auto& [path, value] : leaves.items()) {
        CAPTURE(path);
        // Each part of the daemon names its own counters.
        if (!path.starts_with("/counters/")) CHECK(is_explained(json::json_pointer(path)));
    }
}

TEST_CASE("a row shows the values that are known, and a dash without any") {
    Page page;
    CHECK(row_of(page, "axes") == "(no row)");
    CHECK(row_of(page, "journal") == "-");
    CHECK(row_of(page, "outer oven") == "(no row)");
    CHECK(row_of(page, "battery") == "(no row)");
    CHECK(row_of(page, "signal") ==
          "NO DATA: No values arrive: no sample has been received yet. Check the sensor's plug and "
          "its power supply.");
    CHECK(row_of(page, "troubles") == "none");
    CHECK(row_of(page, "occupation") == "none running");

    fill(page.status);
    page.status.warn("disk nearly full");
    CHECK(row_of(page, "state") == "warning: disk nearly full");
    CHECK(row_of(page, "axes") == "x 1.500 mg, y -2.250 mg, z 999.300 mg");
    CHECK(row_of(page, "journal") == "990, 10 behind (0.2 s)");
    CHECK(row_of(page, "troubles") == "checksum errors 2");
    CHECK(has(page, "timing", "unlocked, uncertainty 1.50 ms, of it the laptop's clock 0.40 ms"));
    CHECK(
        has(page, "disk",
            "free 5.5 GB, reserve given up, longest sync 250 ms, written in an hour 27.3 MB, syncs "
            "in an hour 4980"));
    CHECK(row_of(page, "battery") == "80 %, discharging");
    CHECK(has(page, "sampling", "not verified"));
    page.status.is_profile_verified = true;
    page.status.temperature = DegC(std::numeric_limits<double>::quiet_NaN());
    CHECK(!has(page, "sampling", "not verified"));
    CHECK(row_of(page, "temperature") == "-");
}

TEST_CASE("an oven is one row, with its trouble") {
    Page page;
    CHECK(row_of(page, "oven") == "disabled");
    fill(page.status);
    CHECK(
        has(page, "oven", "answering, 42.5 degC, set point 43.0 degC, heating 25.0 %, age 0.4 s"));
    page.status.oven->state = source::OvenLinkStatus::State::silent;
    page.status.oven->trouble = "no answer";
    page.status.oven->values->process_value.reset();
    page.status.oven->values->status = oven::kInputError;
    page.status.oven->is_stale = true;
    CHECK(
        has(page, "oven",
            "silent, no answer, set point 43.0 degC, heating 25.0 %, input error, age 0.4 s, old"));
}

TEST_CASE("the row of gravity has one value with one uncertainty, or what is missing") {
    Page page;
    page.occupations.start("No.1", {}, minute(50));
    page.status.now = minute(60);
    json status = page.ask(get("/api/status"));
    const auto gravity = [&](const json& known) {
        status["occupation"]["gravity"] = known;
        return operator_rows(status).at(2).text.english();
    };
    CHECK(gravity(nullptr) == "not computed yet");
    CHECK(gravity({{"gravity_mgal", 979800.123}, {"u_mgal", 1.43}, {"missing_parts", nullptr}}) ==
          "979800.1 +- 1.4 mGal");
    CHECK(gravity({{"gravity_mgal", nullptr},
                   {"u_mgal", nullptr},
                   {"missing_parts", json::array({"read a second benchmark"})}}) ==
          "read a second benchmark");
}
