#pragma once

#include <string>

#include "sim/command/options.hpp"

namespace a351::sim {

/// Options of `a351-sim survey`, which writes a simulated day directly to a data root.
struct SurveyCommand {
    DayOptions day;
    std::string profile = "A351";
    std::string out;
};
CLI::App* add_survey(CLI::App& app, SurveyCommand& command);

/// Writes the day, and the numbers of frames and records to stderr.  @throws  as write_survey().
void run(const SurveyCommand& command);

/// Options of `a351-sim plan`, which writes sites, schedule and truth of a simulated day.
struct PlanCommand {
    DayOptions day;
    std::string out;
};
CLI::App* add_plan(CLI::App& app, PlanCommand& command);

/// Writes the tables and prints first and last instant of the day.  @throws  as write_plan().
void run(const PlanCommand& command);

}  // namespace a351::sim
