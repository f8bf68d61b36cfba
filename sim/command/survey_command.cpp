#include "sim/command/survey_command.hpp"

#include <iostream>

#include "sim/scenario/survey_plan.hpp"
#include "sim/survey/direct_survey.hpp"
#include "sim/survey/plan_files.hpp"

namespace a351::sim {

CLI::App* add_survey(CLI::App& app, SurveyCommand& command) {
    CLI::App* survey =
        app.add_subcommand("survey", "Write a simulated day directly to a data root");
    add_day(*survey, command.day);
    add_profile(*survey, command.profile);
    survey->add_option("--out", command.out, "Directory to write: new, or without a simulated day")
        ->type_name("DIR")
        ->required();
    return survey;
}

void run(const SurveyCommand& command) {
    const auto survey = write_survey(load_scenario(command.day.scenario),
                                     profile_of(command.profile), command.day.seed, command.out);
    std::cerr << survey.frames << " frames, " << survey.records << " records\n";
}

CLI::App* add_plan(CLI::App& app, PlanCommand& command) {
    CLI::App* plan =
        app.add_subcommand("plan", "Write sites, schedule and truth of a simulated day");
    add_day(*plan, command.day);
    plan->add_option("--out", command.out, "Directory for the tables; made if it does not exist")
        ->type_name("DIR")
        ->required();
    return plan;
}

void run(const PlanCommand& command) {
    const Scenario scenario = load_scenario(command.day.scenario);
    write_plan(scenario, command.day.seed, command.out);
    std::cout << "start_utc=" << to_rfc3339(scenario.start())
              << " end_utc=" << to_rfc3339(scenario.end()) << '\n';
}

}  // namespace a351::sim
