#pragma once

#include <string>

#include "sim/command/options.hpp"

namespace a351::sim {

/// `a351-sim survey`: a day straight to a data root.
struct SurveyCommand {
    DayOptions day;
    std::string profile = "A351";
    std::string out;
};
CLI::App* add_survey(CLI::App& app, SurveyCommand& command);

/// Says on stderr how much there is.  @throws  as write_survey.
void run(const SurveyCommand& command);

/// `a351-sim plan`: sites, schedule and truth of a day.
struct PlanCommand {
    DayOptions day;
    std::string out;
};
CLI::App* add_plan(CLI::App& app, PlanCommand& command);

/// Prints first and last instant of the day.  @throws  as write_plan.
void run(const PlanCommand& command);

}  // namespace a351::sim
