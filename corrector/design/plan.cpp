#include "corrector/design/plan.hpp"

#include <fmt/core.h>

#include <functional>

#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::design {
namespace {

Visit visit_of(const text::CsvTable& table, std::size_t row, const std::vector<text::Site>& sites) {
    Visit visit;
    visit.site = table.cell(row, "site");
    if (text::find_site(sites, visit.site) == nullptr) {
        const text::Site* const similar = text::similar_site(sites, visit.site);
        table.refuse(row, "site", "unknown",
                     similar != nullptr
                         ? fmt::format("a name of the table of sites; like {}?", similar->name)
                         : "a name of the table of sites");
    }
    const auto start = parse_rfc3339(table.cell(row, "start_utc"));
    if (!start) table.refuse(row, "start_utc", "not an instant", "YYYY-MM-DDThh:mm:ss with zone");
    visit.start = *start;
    const double set_ups = table.number(row, "set_ups", 1.0, kMostSetUps);
    visit.set_ups = static_cast<int>(set_ups);
    if (static_cast<double>(visit.set_ups) != set_ups)
        table.refuse(row, "set_ups", "not whole",
                     fmt::format("a whole number, 1 to {}", kMostSetUps));
    visit.minutes_each = table.number(row, "minutes_each", kFewestMinutes, kMostMinutes);
    if (!table.has_column("faces") || table.cell(row, "faces").empty()) return visit;
    visit.faces = table.cell(row, "faces");
    if (visit.faces.find_first_not_of("+-") != std::string::npos || visit.faces.front() != '+')
        table.refuse(row, "faces", "not a plan of faces",
                     "signs + and -, beginning with +, as +--+");
    if (visit.faces.size() > 1 && std::ssize(visit.faces) != visit.set_ups)
        table.refuse(row, "faces", "not one face for each of the set_ups",
                     fmt::format("{} signs, or + alone", visit.set_ups));
    return visit;
}

void require_order(const text::CsvTable& table, std::size_t row, const Visit& before,
                   const Visit& visit) {
    const double pause_s = seconds_between(before.end(), visit.start);
    if (pause_s < 0.0)
        table.refuse(row, "start_utc", fmt::format("the visit of {} is not over", before.site),
                     fmt::format("{} or later", to_rfc3339(before.end())));
    if (pause_s > kLongestPause_h * kSecondsPerHour)
        table.refuse(
            row, "start_utc", "a long pause, which begins another survey day",
            fmt::format("at most {} h after {}", kLongestPause_h, to_rfc3339(before.end())));
}

}  // namespace

bool is_known(const std::vector<text::Site>& sites, const Visit& visit) {
    return text::find_site(sites, visit.site)->gravity.has_value();
}

std::vector<double> drives_s(const Plan& plan) {
    std::vector<double> drives;
    for (std::size_t i = 1; i < plan.size(); ++i)
        drives.push_back(seconds_between(plan[i - 1].end(), plan[i].start));
    return drives;
}

Plan read_plan(const std::filesystem::path& file, const std::vector<text::Site>& sites) {
    const text::CsvTable table = text::read_csv(file);
    Plan plan;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const Visit visit = visit_of(table, row, sites);
        if (!plan.empty()) require_order(table, row, plan.back(), visit);
        plan.push_back(visit);
    }
    const auto has_gravity = std::bind_front(is_known, std::cref(sites));
    if (std::ranges::none_of(plan, has_gravity))
        throw InputError(
            fmt::format("{}: no site with a gravity_mgal in the table of sites is visited; "
                        "allowed: at least one",
                        file.string()));
    if (std::ranges::all_of(plan, has_gravity))
        throw InputError(fmt::format(
            "{}: every site that is visited has a gravity_mgal in the table of sites; allowed: at "
            "least one without, whose uncertainty is computed",
            file.string()));
    return plan;
}

std::string plan_csv(const Plan& plan) {
    const bool has_faces = is_turned(plan);
    std::string csv =
        fmt::format("site,start_utc,set_ups,minutes_each{}\n", has_faces ? ",faces" : "");
    for (const Visit& visit : plan) {
        const bool is_whole = visit.start == std::chrono::floor<std::chrono::seconds>(visit.start);
        csv += fmt::format("{},{},{},{}{}\n", visit.site, to_rfc3339(visit.start, is_whole ? 0 : 3),
                           visit.set_ups, text::shortest(visit.minutes_each),
                           has_faces ? "," + visit.faces : "");
    }
    return csv;
}

bool is_turned(const Plan& plan) {
    return std::ranges::any_of(
        plan, [](const Visit& visit) { return visit.faces.find('-') != std::string::npos; });
}

double duration_h(const Plan& plan) {
    return seconds_between(plan.front().start, plan.back().end()) / kSecondsPerHour;
}

}  // namespace a351::corrector::design
