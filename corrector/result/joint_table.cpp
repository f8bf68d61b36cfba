#include "corrector/result/joint_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

JointStation join(const std::string& site, const std::vector<model::StationValue>& days) {
    const bool is_weighted = std::ranges::all_of(days, [](const model::StationValue& day) {
        const auto u = day_value(day).u;
        return u && u->value() > 0.0;
    });
    JointStation joint;
    joint.site = site;
    joint.day_count = days.size();
    // The sum is about the first day, so that full values near 980000 keep their last digits.
    const MilliGal origin = day_value(days.front()).gravity;
    std::vector<double> weights;
    double sum = 0.0, of_weights = 0.0;
    for (const model::StationValue& day : days) {
        const DayValue value = day_value(day);
        weights.push_back(is_weighted ? std::pow(value.u->value(), -2) : 1.0);
        sum += weights.back() * (value.gravity - origin).value();
        of_weights += weights.back();
        joint.row_count += day.row_count;
        joint.is_in_sample = joint.is_in_sample || value.is_in_sample;
        if (day.reference) joint.reference = day.reference;
    }
    joint.gravity = origin + MilliGal(sum / of_weights);
    if (is_weighted) {
        double variance = 0.0;
        for (std::size_t i = 0; i < days.size(); ++i)
            for (std::size_t k = 0; k < days.size(); ++k)
                variance += weights[i] * weights[k] *
                            (i == k ? 1.0 / weights[i] : covariance_mgal2(days[i], days[k]));
        joint.u_gravity = MilliGal(std::sqrt(variance) / of_weights);
    }
    if (joint.reference) joint.residual = *joint.reference - joint.gravity;
    return joint;
}

}  // namespace

double covariance_mgal2(const model::StationValue& a, const model::StationValue& b) {
    if (!a.errors || !b.errors || a.errors->is_calibrated != b.errors->is_calibrated) return 0.0;
    return std::inner_product(a.errors->shared_mgal.begin(), a.errors->shared_mgal.end(),
                              b.errors->shared_mgal.begin(), 0.0);
}

DayValue day_value(const model::StationValue& station) {
    if (station.left_out) return {*station.left_out, station.u_left_out, false};
    return {station.gravity, station.u_gravity, station.reference.has_value()};
}

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
        {"site", of(&JointStation::site), {text::marked("Station"), 0, 'n'}},
        {"days", of(&JointStation::day_count), {text::marked("Days")}},
        {"n", of(&JointStation::row_count), {"n"}},
        {"gravity_mgal", of(&JointStation::gravity), {text::marked("Gravity mGal")}},
        {"u_gravity_mgal", of(&JointStation::u_gravity), {text::marked("u mGal"), 2}},
        {"reference_mgal", of(&JointStation::reference), {text::marked("Reference mGal")}},
        {"residual_mgal", of(&JointStation::residual), {text::marked("Residual mGal")}},
        {"in_sample", of(&JointStation::is_in_sample), {text::marked("In sample"), 0, 'l'}},
    };
    return columns;
}

}  // namespace a351::corrector::result
