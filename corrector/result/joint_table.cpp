#include "corrector/result/joint_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "corrector/result/column.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

JointStation join(const std::string& site, const std::vector<StationValue>& days) {
    const bool is_weighted = std::ranges::all_of(days, [](const StationValue& day) {
        return day.u_gravity && day.u_gravity->value() > 0.0;
    });
    JointStation joint;
    joint.site = site;
    joint.day_count = days.size();
    // The sum is about the first day, so that full values near 980000 keep their last digits.
    const MilliGal origin = days.front().gravity;
    double sum = 0.0;
    double weights = 0.0;
    for (const StationValue& day : days) {
        const double u = is_weighted ? day.u_gravity->value() : 1.0;
        sum += (day.gravity - origin).value() / (u * u);
        weights += 1.0 / (u * u);
        joint.row_count += day.row_count;
        if (day.reference) joint.reference = day.reference;
    }
    joint.gravity = origin + MilliGal(sum / weights);
    if (is_weighted) joint.u_gravity = MilliGal(1.0 / std::sqrt(weights));
    if (joint.reference) joint.residual = *joint.reference - joint.gravity;
    return joint;
}

}  // namespace

std::vector<JointStation> join_days(const std::vector<SurveyCorrection>& days) {
    std::vector<std::string> sites;
    std::map<std::string, std::vector<StationValue>> values;
    for (const SurveyCorrection& day : days) {
        for (const StationValue& station : day.stations) {
            std::vector<StationValue>& of_site = values[station.site];
            if (of_site.empty()) sites.push_back(station.site);
            of_site.push_back(station);
        }
    }
    std::vector<JointStation> joint;
    for (const std::string& site : sites) joint.push_back(join(site, values[site]));
    return joint;
}

std::vector<std::string> joint_cells(const JointStation& station) {
    return {station.site,
            std::to_string(station.day_count),
            std::to_string(station.row_count),
            text::fixed(station.gravity.value(), 3),
            text::fixed_or(station.u_gravity, 2, "-"),
            text::fixed_or(station.reference, 3, "-"),
            text::fixed_or(station.residual, 3, "-")};
}

std::string joint_csv(const std::vector<JointStation>& stations) {
    using Station = const JointStation&;
    const std::vector<Column<JointStation>> columns{
        {"site", [](Station station) { return station.site; }},
        {"days", [](Station station) { return cell_of_count(station.day_count); }},
        {"n", [](Station station) { return cell_of_count(station.row_count); }},
        {"gravity_mgal", [](Station station) { return cell(station.gravity); }},
        {"u_gravity_mgal", [](Station station) { return cell(station.u_gravity); }},
        {"reference_mgal", [](Station station) { return cell(station.reference); }},
        {"residual_mgal", [](Station station) { return cell(station.residual); }},
    };
    return csv_table(columns, stations);
}

std::string joint_text(const std::vector<JointStation>& stations) {
    std::vector<std::vector<std::string>> rows{
        {"station", "days", "n", "gravity mGal", "u", "reference", "residual"}};
    for (const JointStation& station : stations) rows.push_back(joint_cells(station));
    return text::aligned(rows);
}

}  // namespace a351::corrector
