#include "corrector/result/joint_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

/// The value of a station on one day, and its weight in the mean of the days.
struct Member {
    const model::SurveyCorrection* day;
    const model::StationValue* station;
    DayValue value;
    double weight = 1.0;  ///< The weights of a station have the sum 1.
};

/// A station and its values.
struct Members {
    std::string site;
    std::vector<Member> days;
};

void set_weights(std::vector<Member>& days) {
    const bool is_weighted = std::ranges::all_of(
        days, [](const Member& day) { return day.value.u && day.value.u->value() > 0.0; });
    double sum = 0.0;
    for (Member& day : days) {
        if (is_weighted) day.weight = std::pow(day.value.u->value(), -2);
        sum += day.weight;
    }
    for (Member& day : days) day.weight /= sum;
}

std::vector<Members> members_of(const std::vector<model::SurveyCorrection>& days) {
    std::vector<Members> stations;
    for (const model::SurveyCorrection& day : days)
        for (const model::StationValue& station : day.stations) {
            auto found = std::ranges::find(stations, station.site, &Members::site);
            if (found == stations.end()) found = stations.insert(found, {station.site, {}});
            found->days.push_back({&day, &station, day_value(station)});
        }
    for (Members& station : stations) set_weights(station.days);
    return stations;
}

/// Returns the correlation of two stations of one day; absent if the day does not give that of values
/// without the own reference.
std::optional<double> correlation(const model::SurveyCorrection& day, const std::string& a,
                                  const std::string& b) {
    if (!day.covariance || day.as<model::NetworkPart>() != nullptr) return std::nullopt;
    const auto& [sites, mgal2] = *day.covariance;
    const auto of_a = std::ranges::find(sites, a), of_b = std::ranges::find(sites, b);
    if (of_a == sites.end() || of_b == sites.end()) return std::nullopt;
    const auto i = of_a - sites.begin(), k = of_b - sites.begin();
    const double product = mgal2(i, i) * mgal2(k, k);
    return product > 0.0 ? mgal2(i, k) / std::sqrt(product) : 0.0;
}

std::optional<double> covariance_of(const Member& a, const Member& b) {
    if (!a.value.u || !b.value.u) return std::nullopt;
    if (a.day != b.day) return covariance_mgal2(*a.station, *b.station);
    const double product = a.value.u->value() * b.value.u->value();
    if (a.station == b.station) return product;
    const auto of_day = correlation(*a.day, a.station->site, b.station->site);
    if (!of_day) return std::nullopt;
    return product * *of_day;
}

/// Returns the covariance of the means of two stations, which may be one; absent if that of two values
/// is not known.
std::optional<double> covariance_of(const Members& a, const Members& b) {
    double sum = 0.0;
    for (const Member& of_a : a.days)
        for (const Member& of_b : b.days) {
            const auto covariance = covariance_of(of_a, of_b);
            if (!covariance) return std::nullopt;
            sum += of_a.weight * of_b.weight * *covariance;
        }
    return sum;
}

JointStation join(const Members& station) {
    JointStation joint;
    joint.site = station.site;
    joint.day_count = station.days.size();
    // The sum is about the first day, so that full values near 980000 keep their last digits.
    const MilliGal origin = station.days.front().value.gravity;
    double sum = 0.0;
    for (const Member& day : station.days) {
        sum += day.weight * (day.value.gravity - origin).value();
        joint.row_count += day.station->row_count;
        joint.is_in_sample = joint.is_in_sample || day.value.is_in_sample;
        if (day.station->reference) joint.reference = day.station->reference;
    }
    joint.gravity = origin + MilliGal(sum);
    if (const auto variance = covariance_of(station, station))
        joint.u_gravity = MilliGal(std::sqrt(*variance));
    if (joint.reference) joint.residual = *joint.reference - joint.gravity;
    return joint;
}

}  // namespace

double covariance_mgal2(const model::StationValue& a, const model::StationValue& b) {
    if (!a.shared || !b.shared) return 0.0;
    double sum = 0.0;
    for (const auto& [site, of_a] : a.shared->references_mgal)
        if (const auto of_b = b.shared->references_mgal.find(site);
            of_b != b.shared->references_mgal.end())
            sum += of_a * of_b->second;
    if (a.shared->is_calibrated != b.shared->is_calibrated) return sum;
    return std::inner_product(a.shared->unit_mgal.begin(), a.shared->unit_mgal.end(),
                              b.shared->unit_mgal.begin(), sum);
}

DayValue day_value(const model::StationValue& station) {
    if (station.left_out) return {*station.left_out, station.u_left_out, false};
    if (station.shared && station.reference)
        return {*station.reference, MilliGal(station.shared->references_mgal.at(station.site)),
                true};
    return {station.gravity, station.u_gravity, station.reference.has_value()};
}

std::vector<JointStation> join_days(const std::vector<model::SurveyCorrection>& days) {
    std::vector<JointStation> joint;
    for (const Members& station : members_of(days)) joint.push_back(join(station));
    return joint;
}

std::vector<model::StationDifference> joint_differences(
    const std::vector<model::SurveyCorrection>& days) {
    const std::vector<Members> stations = members_of(days);
    const std::vector<JointStation> joint = join_days(days);
    std::vector<model::StationDifference> differences;
    for (std::size_t b = 0; b < stations.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            const auto covariance = covariance_of(stations[a], stations[b]);
            const auto of_a = covariance_of(stations[a], stations[a]),
                       of_b = covariance_of(stations[b], stations[b]);
            if (!covariance || !of_a || !of_b) continue;
            model::StationDifference difference{
                joint[a].site, joint[b].site, joint[b].gravity - joint[a].gravity,
                MilliGal(std::sqrt(std::max(0.0, *of_a + *of_b - 2.0 * *covariance))),
                std::nullopt};
            if (joint[a].reference && joint[b].reference)
                difference.reference = *joint[b].reference - *joint[a].reference;
            differences.push_back(std::move(difference));
        }
    return differences;
}

JointTables joint_tables(const std::vector<model::SurveyCorrection>& days,
                         const model::JointAdjustment* adjustment) {
    JointTables tables{join_days(days), {}};
    if (adjustment == nullptr) {
        tables.differences = joint_differences(days);
        return tables;
    }
    for (JointStation& station : tables.stations) {
        const auto found =
            std::ranges::find(adjustment->stations, station.site, &model::JointGravity::site);
        if (found == adjustment->stations.end()) continue;
        station.gravity = found->gravity;
        station.u_gravity = found->u;
        station.is_in_sample = found->is_in_sample;
        if (station.reference) station.residual = *station.reference - station.gravity;
    }
    tables.differences = adjustment->differences;
    return tables;
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
