#include "corrector/result/joint_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace a351::corrector::result {
namespace {

JointStation join(const std::string& site, const std::vector<model::StationValue>& days) {
    const bool is_weighted = std::ranges::all_of(days, [](const model::StationValue& day) {
        return day.u_gravity && day.u_gravity->value() > 0.0;
    });
    JointStation joint;
    joint.site = site;
    joint.day_count = days.size();
    // The sum is about the first day, so that full values near 980000 keep their last digits.
    const MilliGal origin = days.front().gravity;
    double sum = 0.0;
    double weights = 0.0;
    for (const model::StationValue& day : days) {
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

std::vector<JointStation> join_days(const std::vector<model::SurveyCorrection>& days) {
    std::vector<std::string> sites;
    std::map<std::string, std::vector<model::StationValue>> values;
    for (const model::SurveyCorrection& day : days) {
        for (const model::StationValue& station : day.stations) {
            std::vector<model::StationValue>& of_site = values[station.site];
            if (of_site.empty()) sites.push_back(station.site);
            of_site.push_back(station);
        }
    }
    std::vector<JointStation> joint;
    for (const std::string& site : sites) joint.push_back(join(site, values[site]));
    return joint;
}

const std::vector<Column<JointStation>>& joint_columns() {
    static const std::vector<Column<JointStation>> columns{
        {"site", of(&JointStation::site), {"Station", 0, 'n'}},
        {"days", of(&JointStation::day_count), {"Days"}},
        {"n", of(&JointStation::row_count), {"n"}},
        {"gravity_mgal", of(&JointStation::gravity), {"Gravity mGal"}},
        {"u_gravity_mgal", of(&JointStation::u_gravity), {"u mGal", 2}},
        {"reference_mgal", of(&JointStation::reference), {"Reference mGal"}},
        {"residual_mgal", of(&JointStation::residual), {"Residual mGal"}},
    };
    return columns;
}

}  // namespace a351::corrector::result
