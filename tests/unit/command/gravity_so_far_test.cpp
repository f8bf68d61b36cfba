// Gravity so far by the program: `survey --json` on the data root of a made-up morning.
#include <set>
#include "tests/unit/command/run_command.hpp"
#include "tests/unit/reading/morning.hpp"

using namespace a351;

namespace {

void log_stay(const Morning& morning, std::size_t i, const std::string& site = {}) {
    events::Event start = Morning::start_event(i);
    if (!site.empty()) start.details["site"] = site;
    morning.log(start);
    morning.log(Morning::stop_event(i));
}

/// Returns all files below the folder with their sizes.
std::set<std::pair<std::string, std::uintmax_t>> files_of(const Morning& morning) {
    std::set<std::pair<std::string, std::uintmax_t>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(morning.folder().path()))
        if (entry.is_regular_file() && entry.path().extension() != ".txt")
            files.emplace(entry.path().string(), entry.file_size());
    return files;
}

nlohmann::json so_far(const Morning& morning, const std::string& options = "") {
    const Outcome outcome = run(morning.folder(), "survey data --json " + options);
    CAPTURE(outcome.errors);
    REQUIRE(outcome.status == 0);
    return nlohmann::json::parse(outcome.output);
}

}  // namespace

TEST_CASE("the gravity so far has each stay's value, and nothing is written") {
    const Morning morning;
    for (std::size_t i = 0; i < 4; ++i) log_stay(morning, i);
    const auto before = files_of(morning);
    const auto answer = so_far(morning, "--model t");
    CHECK(files_of(morning) == before);
    CHECK(answer.at("reason").is_null());
    CHECK(answer.at("model") == "t");
    const auto& stays = answer.at("stays");
    REQUIRE(stays.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(stays[i].at("site") == Morning::kSites[i]);
        CHECK(stays[i].at("occupation") == (i == 3 ? 2 : 1));
        CHECK(stays[i].at("set_ups") == 1);
        CHECK(stays[i].at("is_running") == false);
        CHECK(stays[i].at("gravity_mgal").get<double>() ==
              Approx(Morning::kGravity_mgal[i]).epsilon(0).margin(1.0));
        CHECK(stays[i].at("u_mgal").is_number());
    }
    CHECK(answer.at("data_to_utc").is_string());
}

TEST_CASE("each reason for which there is no gravity so far has its code") {
    const Morning morning;
    const auto reason = [&] { return so_far(morning).at("reason"); };
    CHECK(reason() == "no_stay");
    log_stay(morning, 0, "No.99");
    CHECK(reason() == "no_usable_stay");
    log_stay(morning, 1);
    CHECK(reason() == "too_few_readings");
    log_stay(morning, 2);
    CHECK(reason().is_null());
    morning.folder().write("sites.csv",
                           "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                           "B,140.1,36.2,500,979800\nS1,140.0,36.1,200,\nS2,140.2,36.3,800,\n");
    CHECK(reason() == "no_reference");
    std::filesystem::remove_all(morning.folder().path() / "data/archive");
    CHECK(reason() == "no_reading");
    std::filesystem::remove_all(morning.folder().path() / "data/metadata");
    CHECK(reason() == "no_metadata");
}

TEST_CASE("a data root takes its sites from --sites, or from the folder that contains it") {
    const Morning morning;
    for (std::size_t i = 0; i < 4; ++i) log_stay(morning, i);
    std::filesystem::rename(morning.folder().path() / "sites.csv",
                            morning.folder().path() / "list.csv");
    CHECK(run(morning.folder(), "survey data --json").status == 2);
    CHECK(so_far(morning, "--sites list.csv --model t").at("stays").size() == 4);
    morning.folder().write("day.toml", "[survey]\nsites = 'list.csv'\n");
    CHECK(run(morning.folder(), "survey day.toml --sites list.csv --json").status == 2);
    CHECK(run(morning.folder(), "survey data data --sites list.csv --json").status == 2);
    CHECK(run(morning.folder(), "survey data --sites list.csv --model t").status == 0);
    CHECK(std::filesystem::exists(morning.folder().path() / "result/report.html"));
}
