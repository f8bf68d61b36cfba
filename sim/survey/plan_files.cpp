#include "sim/survey/plan_files.hpp"

#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/set_up_truth.hpp"

namespace a351::sim {

void write_plan(const Scenario& scenario, std::uint64_t seed,
                const std::filesystem::path& directory) {
    const std::vector<PlannedSetUp> plan = plan_survey(scenario, seed);
    const std::string truth = truth_csv(scenario, plan, seed);
    std::filesystem::create_directories(directory);
    write_text_file(directory / "sites.csv", sites_csv(scenario));
    write_text_file(directory / "schedule.csv", schedule_csv(plan));
    write_text_file(directory / "truth.csv", truth);
}

}  // namespace a351::sim
