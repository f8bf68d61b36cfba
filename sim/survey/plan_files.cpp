#include "sim/survey/plan_files.hpp"

#include <algorithm>

#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/set_up_truth.hpp"
#include "sim/signal/true_time.hpp"

namespace a351::sim {

void write_plan(const Scenario& scenario, std::uint64_t seed,
                const std::filesystem::path& directory) {
    const std::vector<PlannedSetUp> plan = plan_survey(scenario, seed);
    const std::string truth = truth_csv(scenario, plan, seed);
    std::filesystem::create_directories(directory);
    write_text_file(directory / "sites.csv", sites_csv(scenario));
    write_text_file(directory / "schedule.csv", schedule_csv(by_true_time(scenario, plan, seed)));
    write_text_file(directory / "truth.csv", truth);
}

bool has_two_sites(const Scenario& scenario) {
    return std::ranges::any_of(scenario.occupations, [&](const ListedOccupation& one) {
        return one.site != scenario.occupations.front().site;
    });
}

void write_survey_file(const Scenario& scenario, const std::filesystem::path& directory) {
    write_text_file(
        directory / "survey.toml",
        "# Simulated day; true gravity: truth.csv.  occupations = \"\" uses the event log, which\n"
        "# has the same times.\n"
        "[survey]\n"
        "name = \"" +
            scenario.name +
            "\"\n"
            "root = \".\"\n"
            "sites = \"sites.csv\"\n"
            "occupations = \"schedule.csv\"\n"
            "base = \"" +
            scenario.sites.front().name +
            "\"\n"
            "model = \"auto\"\n"
            "flags = \"ignore\"\n");
}

}  // namespace a351::sim
