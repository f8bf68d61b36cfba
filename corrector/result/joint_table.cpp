#include "corrector/result/joint_table.hpp"

#include <algorithm>
#include <numeric>

#include "corrector/result/answer.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {

JointTables joint_tables(const std::vector<model::RecordedSurvey>& surveys,
                         const model::JointAdjustment* adjustment) {
    JointTables tables;
    auto& stations = tables.stations;
    for (const model::RecordedSurvey& survey : surveys)
        for (const model::StationValue& value : survey.result->stations) {
            auto found = std::ranges::find(stations, value.site, &JointStation::site);
            if (found == stations.end()) {
                found = stations.emplace(found);
                found->site = value.site;
            }
            ++found->day_count;
            found->row_count += value.row_count;
            found->is_in_sample = found->is_in_sample || day_value(value).is_in_sample;
            if (value.reference) found->reference = value.reference;
        }
    if (adjustment == nullptr) return tables;
    for (JointStation& station : stations) {
        const auto found =
            std::ranges::find(adjustment->stations, station.site, &model::JointGravity::site);
        if (found == adjustment->stations.end()) continue;
        station.gravity = found->gravity;
        station.u_gravity = found->u;
        station.is_in_sample = found->is_in_sample;
        if (station.reference) station.residual = *station.gravity - *station.reference;
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

Table table_by_survey(const std::vector<JointStation>& stations,
                      const std::vector<model::RecordedSurvey>& surveys, bool is_adjusted) {
    const int decimals = surveys.empty() ? 1 : decimals_of(*surveys.front().result);
    Table table = table_of(with_decimals(joint_columns(), decimals), stations);
    for (const model::RecordedSurvey& survey : surveys) {
        table.alignment += 'r';
        table.headings.push_back(is_adjusted ? text::tr("{} - joint", survey.name) : survey.name);
        for (std::size_t i = 0; i < stations.size(); ++i) {
            std::string& cell = table.rows[i].emplace_back("-");
            const model::StationValue* const station = survey.result->station(stations[i].site);
            if (station == nullptr || (is_adjusted && !stations[i].gravity)) continue;
            const DayValue value = day_value(*station);
            const int digits =
                text::decimals_for(value.u ? std::optional(value.u->value()) : std::nullopt);
            const auto shown = [digits](MilliGal gravity) {
                return text::fixed(gravity.value(), digits);
            };
            if (is_adjusted)
                cell = shown(value.gravity - *stations[i].gravity);
            else
                cell = shown(value.gravity) + (value.u ? " +- " + shown(*value.u) : "");
            if (station->is_flagged_only) cell += " *";
        }
    }
    return table;
}

DayValue day_value(const model::StationValue& station) {
    if (station.left_out) return {*station.left_out, station.u_left_out, false};
    if (station.shared && station.reference)
        return {*station.reference, MilliGal(station.shared->references_mgal.at(station.site)),
                true};
    return {station.gravity, station.u_gravity, station.reference.has_value()};
}

double covariance_mgal2(const model::StationValue& a, const model::StationValue& b) {
    if (!a.shared || !b.shared) return 0.0;
    double sum = 0.0;
    for (const auto& [site, of_a] : a.shared->references_mgal)
        if (const auto of_b = b.shared->references_mgal.find(site);
            of_b != b.shared->references_mgal.end())
            sum += of_a * of_b->second;
    if (a.shared->is_calibrated != b.shared->is_calibrated || a.shared->unit_mgal.empty() ||
        b.shared->unit_mgal.empty())
        return sum;
    return std::inner_product(a.shared->unit_mgal.begin(), a.shared->unit_mgal.end(),
                              b.shared->unit_mgal.begin(), sum);
}

}  // namespace a351::corrector::result
