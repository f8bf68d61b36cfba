#include "sim/command/exit_report.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "protocol/text/json_text.hpp"
#include "sim/oven/oven_port.hpp"

namespace a351::sim::command {
namespace {

using nlohmann::ordered_json;

double seconds(Nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

ordered_json runs_of(const line::Report& line) {
    ordered_json runs = ordered_json::array();
    for (const line::Report::Run& run : line.runs) {
        runs.push_back({{"first_index", run.first_index}, {"frames", run.frames}});
    }
    return runs;
}

ordered_json by_kind(const line::FaultReport& faults) {
    ordered_json kinds = ordered_json::object();
    for (std::size_t i = 0; i < line::fault_kinds().size(); ++i) {
        if (faults.by_kind[i] > 0) kinds[std::string(line::fault_kinds()[i])] = faults.by_kind[i];
    }
    if (faults.by_kind.back() > 0) kinds["oven"] = faults.by_kind.back();
    return kinds;
}

ordered_json applied(const line::FaultReport& faults) {
    ordered_json list = ordered_json::array();
    for (const line::AppliedFault& fault : faults.applied) {
        list.push_back({{"kind", fault.name},
                        {"utc", to_rfc3339(fault.at)},
                        {"frames_made", fault.frames_made}});
    }
    return list;
}

ordered_json refused(const line::FaultReport& faults) {
    ordered_json list = ordered_json::array();
    for (const line::RefusedFault& fault : faults.refused) {
        list.push_back(
            {{"kind", fault.name}, {"utc", to_rfc3339(fault.at)}, {"reason", fault.reason}});
    }
    return list;
}

ordered_json to_json(const oven::Report& oven) {
    const auto kinds = oven::Port::fault_kinds();
    ordered_json faults = ordered_json::object();
    for (std::size_t i = 0; i < oven::kOvenFaultCount; ++i) {
        if (oven.faults[i] > 0) faults[std::string(kinds[i])] = oven.faults[i];
    }
    return {{"answers", oven.answers},
            {"exceptions", oven.exceptions},
            {"answers_lost", oven.answers_lost},
            {"resets", oven.resets},
            {"broadcasts", oven.broadcasts},
            {"for_other_units", oven.for_other_units},
            {"unreadable", oven.unreadable},
            {"unheard", oven.ignored},
            {"faults", faults}};
}

}  // namespace

std::string to_json(const ExitReport& report, int indent) {
    const line::Report& line = report.line;
    const double lateness_s = seconds(line.largest_lateness);
    const double rate_hz = report.real_seconds > 0.0
                               ? static_cast<double>(line.frames_sent) / report.real_seconds
                               : 0.0;
    ordered_json json = {
        {"scenario", report.scenario},
        {"seed", report.seed},
        {"frames_made", line.frames_made},
        {"frames_sent", line.frames_sent},
        {"frames_damaged", line.frames_damaged},
        {"frames_lost", line.frames_lost},
        {"frames_lost_by_overrun", line.lost_by_overrun},
        {"frames_lost_unplugged", line.lost_unplugged},
        {"frames_pending", line.frames_pending},
        {"frames_repeated", line.frames_repeated},
        {"frames_misplaced", line.frames_misplaced},
        {"frames_flagged", line.frames_flagged},
        {"bytes_handed_over", line.bytes_handed_over},
        {"bytes_of_frames", line.bytes_of_frames},
        {"bytes_of_answers", line.bytes_of_answers},
        {"bytes_dropped", report.faults.bytes_dropped},
        {"bytes_inserted", report.faults.bytes_inserted},
        {"bytes_garbage", report.faults.bytes_garbage},
        {"bytes_unread", report.bytes_unread},
        {"runs", runs_of(line)},
        {"largest_lateness_s", lateness_s},
        {"largest_lateness_real_s", lateness_s / report.speed},
        {"steady_lateness_s", seconds(line.steady_lateness)},
        {"frames_late", line.frames_late},
        {"mean_rate_real_hz", rate_hz},
        {"commands", report.commands},
        {"drained", report.was_drained},
        {"frames_cut", report.faults.frames_cut},
        {"faults", by_kind(report.faults)},
        {"faults_applied", applied(report.faults)},
        {"faults_refused", refused(report.faults)},
        {"faults_applied_in_all", report.faults.applied_in_all},
        {"faults_refused_in_all", report.faults.refused_in_all},
    };
    if (report.oven) json["oven"] = to_json(*report.oven);
    if (report.outer_oven) json["outer_oven"] = to_json(*report.outer_oven);
    return text::json_text(json, indent);
}

}  // namespace a351::sim::command
