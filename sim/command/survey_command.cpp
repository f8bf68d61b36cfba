#include <iostream>
#include <memory>

#include "sim/command/commands.hpp"
#include "sim/command/options.hpp"
#include "sim/survey/direct_survey.hpp"

namespace a351::sim::command {
namespace {

struct SurveyCommand {
    DayOptions day;
    UnitOptions unit;
    std::string out;
};

}  // namespace

void add_survey_command(CLI::App& app) {
    const auto command = std::make_shared<SurveyCommand>();
    CLI::App* survey =
        app.add_subcommand("survey", "Writes a simulated day directly to a data root.");
    add_day(*survey, command->day);
    add_profile(*survey, command->unit.profile);
    add_serial(*survey, command->unit.serial);
    survey
        ->add_option("--out", command->out, "Data root to write: new, or without any file of a day")
        ->type_name("DIR")
        ->required();
    survey->callback([command] {
        const auto written = survey::write_survey(
            scenario::load_scenario(command->day.scenario), profile_of(command->unit.profile),
            command->day.seed, command->out, command->unit.serial);
        std::cerr << written.frames << " frames, " << written.records << " records\n";
    });
}

void add_plan_command(CLI::App& app) {
    const auto command = std::make_shared<SurveyCommand>();
    CLI::App* plan =
        app.add_subcommand("plan", "Writes sites, schedule and truth of a simulated day.");
    add_day(*plan, command->day);
    plan->add_option("--out", command->out,
                     "Directory of the tables; it is made if it does not exist")
        ->type_name("DIR")
        ->required();
    plan->callback([command] {
        const scenario::Scenario scenario = scenario::load_scenario(command->day.scenario);
        survey::write_plan(scenario, command->day.seed, command->out);
        std::cout << "start_utc=" << to_rfc3339(scenario.start())
                  << " end_utc=" << to_rfc3339(scenario.end()) << '\n';
    });
}

}  // namespace a351::sim::command
