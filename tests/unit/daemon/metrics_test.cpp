#include "daemon/page/metrics.hpp"

#include <regex>
#include <set>
#include <sstream>

#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

namespace {

std::string metrics_of(Page& page) {
    const auto answer = page.api.answer(get("/metrics"));
    CHECK(answer.status == 200);
    CHECK(answer.content_type == "text/plain; version=0.0.4; charset=utf-8");
    return answer.body;
}

bool has_line(const std::string& text, const std::string& line) {
    const bool is_there = ('\n' + text).find('\n' + line + '\n') != std::string::npos;
    UNSCOPED_INFO("expected line: " << line);
    return is_there;
}

/// A page of a recorder that has all values and a counter with an odd name.
struct BusyPage : Page {
    BusyPage() {
        fill(status);
        status.level = status::Status::Level::warning;
        status.more_counters["odd \"\\\nkind"] = 4;
    }
};

}  // namespace

TEST_CASE("metrics carry the status in base units") {
    BusyPage page;
    page.api.use().connections = 9;
    page.api.use().streams = 4;
    page.api.use().messages_dropped = 17;
    const auto text = metrics_of(page);
    CAPTURE(text);
    for (const char* line : {R"(a351_up{version="1.2"} 1)",
                             R"(a351_level{level="good"} 0)",
                             R"(a351_level{level="warning"} 1)",
                             R"(a351_index{stage="received"} 1000)",
                             R"(a351_index{stage="journaled"} 990)",
                             "a351_sample_age_seconds 0.5",
                             "a351_timing_uncertainty_seconds 0.0015",
                             R"(a351_counter_total{kind="checksum_errors"} 2)",
                             R"(a351_counter_total{kind="odd \"\\\nkind"} 4)",
                             "a351_archive_records_waiting 5",
                             R"(a351_temperature_celsius{at="sensor"} 31.25)",
                             R"(a351_temperature_celsius{at="oven"} 42.5)",
                             R"(a351_temperature_celsius{at="set_point"} 43.0)",
                             "a351_oven_heating_ratio 0.25",
                             R"(a351_oven_polls_total{outcome="answered"} 7)",
                             "a351_disk_free_bytes 5500000000",
                             "a351_longest_sync_seconds 0.25",
                             "a351_disk_written_bytes_total 8192",
                             "a351_disk_syncs_total 3",
                             "a351_page_connections 9",
                             "a351_page_streams 4",
                             "a351_page_messages_dropped_total 17",
                             "a351_page_failures_total 0",
                             "a351_occupation_running 0"})
        CHECK(has_line(text, line));
    CHECK(text.find("archive_records_waiting\"") == std::string::npos);
}

TEST_CASE("before the first sample the metrics show no data and no invented values") {
    Page page;
    const auto text = metrics_of(page);
    CAPTURE(text);
    CHECK(has_line(text, R"(a351_signal{word="no_data"} 1)"));
    CHECK(has_line(text, R"(a351_signal{word="go"} 0)"));
    CHECK(text.find("null") == std::string::npos);
    for (const char* name :
         {"\na351_sample_age_seconds ", "\na351_index{", "\na351_disk_free_bytes "})
        CHECK(text.find(name) == std::string::npos);
}

TEST_CASE("metrics follow the text format: each is declared once, before its samples") {
    // Names and labels as the page "Exposition formats" of Prometheus defines them.
    const std::regex sample(
        R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{[a-z_]+="([^"\\]|\\["\\n])*"\})? -?[0-9.e+-]+)re");
    std::set<std::string> declared;
    std::string name;
    BusyPage page;
    std::istringstream lines(metrics_of(page));
    for (std::string line; std::getline(lines, line);) {
        CAPTURE(line);
        if (line.starts_with("# HELP ")) {
            name = line.substr(7, line.find(' ', 7) - 7);
            CHECK(declared.insert(name).second);
        } else if (line.starts_with("# TYPE ")) {
            CHECK((line == "# TYPE " + name + " gauge" || line == "# TYPE " + name + " counter"));
            CHECK(line.ends_with("counter") == name.ends_with("_total"));
        } else {
            std::smatch parts;
            REQUIRE(std::regex_match(line, parts, sample));
            CHECK(parts[1] == name);
        }
    }
    CHECK(declared.size() > 15);
}
