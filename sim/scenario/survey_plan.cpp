#include "sim/scenario/survey_plan.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "protocol/text/csv.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim {
namespace {

using text::shortest;

/// The box has to be carried at least this long; only a scenario with very close times needs it.
constexpr double kShortestDriveSeconds = 60.0;

std::string interval(const PlannedOccupation& occupation) {
    return occupation.site.name + "," + std::to_string(occupation.number) + "," +
           to_rfc3339(occupation.start, 3) + "," + to_rfc3339(occupation.end, 3);
}

}  // namespace

std::vector<PlannedOccupation> plan_survey(const Scenario& scenario, std::uint64_t seed) {
    RandomStream stream(seed, "schedule");
    const ScheduleParameters& p = scenario.schedule;
    std::vector<PlannedOccupation> plan;
    for (const ListedOccupation& listed : scenario.occupations) {
        PlannedOccupation planned;
        planned.site = *text::find_site(scenario.sites, listed.site);
        planned.number = listed.number;
        planned.is_outlier = listed.is_outlier;
        const double shift_s = stream.uniform(-p.jitter_s, p.jitter_s);
        const double length_s =
            std::max(p.shortest_s, p.length_s + stream.uniform(-p.jitter_s, p.jitter_s));
        planned.start = listed.centre + from_seconds(shift_s - 0.5 * length_s);
        planned.arrival = scenario.start();
        if (!plan.empty()) {
            const UtcTime left = plan.back().end;
            planned.start = std::max(planned.start, left + from_seconds(kShortestDriveSeconds));
            planned.arrival = left + (planned.start - left) / 2;
        }
        planned.start = std::chrono::floor<std::chrono::milliseconds>(planned.start);
        planned.end =
            std::chrono::floor<std::chrono::milliseconds>(planned.start + from_seconds(length_s));
        plan.push_back(planned);
    }
    return plan;
}

std::string sites_csv(const Scenario& scenario) {
    std::string csv = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";
    for (const text::Site& site : scenario.sites) {
        csv += site.name + "," + shortest(site.longitude.value()) + "," +
               shortest(site.latitude.value()) + "," + shortest(site.altitude.value()) + "," +
               shortest(site.gravity->value()) + "\n";
    }
    return csv;
}

std::string schedule_csv(const std::vector<PlannedOccupation>& plan) {
    std::string csv = "site,occupation,start_utc,end_utc,used,note\n";
    for (const PlannedOccupation& occupation : plan) {
        csv += interval(occupation) +
               (occupation.is_outlier ? ",0,left out by the publication\n" : ",1,\n");
    }
    return csv;
}

std::string truth_csv(const std::vector<PlannedOccupation>& plan) {
    std::string csv = "site,occupation,start_utc,end_utc,gravity_mgal,used\n";
    for (const PlannedOccupation& occupation : plan) {
        csv += interval(occupation) + "," + shortest(occupation.site.gravity->value()) +
               (occupation.is_outlier ? ",0\n" : ",1\n");
    }
    return csv;
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) throw std::system_error(errno, std::generic_category(), file.string());
}

void write_plan(const Scenario& scenario, const std::vector<PlannedOccupation>& plan,
                const std::filesystem::path& directory) {
    write_text_file(directory / "sites.csv", sites_csv(scenario));
    write_text_file(directory / "schedule.csv", schedule_csv(plan));
    write_text_file(directory / "truth.csv", truth_csv(plan));
}

}  // namespace a351::sim
