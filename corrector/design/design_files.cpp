#include "corrector/design/design_files.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "corrector/result/columns.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::corrector::design {
namespace {

using Json = nlohmann::ordered_json;
using result::Column;
using result::of;

std::vector<Column<ExpectedStation>> station_columns() {
    std::vector<Column<ExpectedStation>> columns{
        {"site", of(&ExpectedStation::site), {"Station", 0, 'n'}},
        {"is_known", of(&ExpectedStation::is_known), {"Known", 0, 'l'}},
        {"set_ups", of(&ExpectedStation::set_ups), {"Set-ups"}},
        {"u_mgal", of(&ExpectedStation::u), {"u mGal", 2}},
    };
    result::append_contributions(
        columns, [](const ExpectedStation& station) { return &station.parts_mgal; });
    return columns;
}

std::vector<Column<ExpectedDifference>> difference_columns() {
    return {{"from", of(&ExpectedDifference::from)},
            {"to", of(&ExpectedDifference::to)},
            {"u_difference_mgal", of(&ExpectedDifference::u)}};
}

std::vector<Column<Alternative>> alternative_columns() {
    return {{"text", of(&Alternative::text), {"What would improve it", 0, 'l'}},
            {"plan_change", [](const Alternative& one) { return plan_csv(one.plan); }},
            {"u_mgal", of(&Alternative::u), {"u mGal", 2}},
            {"extra_minutes", of(&Alternative::extra_minutes), {"Extra min", 0}}};
}

std::size_t count_known(const Design& design) {
    return static_cast<std::size_t>(
        std::ranges::count(design.errors.stations, true, &ExpectedStation::is_known));
}

std::size_t count_set_ups(const Design& design) {
    std::size_t count = 0;
    for (const ExpectedStation& station : design.errors.stations) count += station.set_ups;
    return count;
}

}  // namespace

Design make_design(const Plan& plan, const std::vector<text::Site>& sites,
                   const PlannedUnit& unit) {
    Design design{plan, unit, expected_errors(plan, sites, unit), {}};
    design.alternatives = alternatives(plan, sites, unit, design.errors.u_unknown);
    return design;
}

std::vector<text::NamedText> design_files(const Design& design,
                                          const std::vector<text::InputFile>& inputs) {
    return {{"design.csv", result::csv_table(station_columns(), design.errors.stations)},
            {"differences.csv", result::csv_table(difference_columns(), design.errors.differences)},
            {"design.json", design_json(design, inputs)}};
}

std::string design_json(const Design& design, const std::vector<text::InputFile>& inputs) {
    Json json;
    json["program"] = "a351-correct";
    json["version"] = A351_VERSION;
    json["inputs"] = inputs;
    const PlannedUnit& unit = design.unit;
    json["unit"] = {
        {"origin", unit.origin},
        {"placement_mgal", unit.noise.placement_mgal},
        {"flicker_mgal", unit.noise.flicker_mgal},
        {"white_mgal", unit.noise.white_mgal},
        {"walk_degc_per_sqrt_h", unit.walk_degc_per_sqrt_h},
        {"tilt_g", unit.tilt_g},
        {"scale_share",
         unit.priors.scale_share.is_measured ? Json(unit.priors.scale_share.mean) : Json(nullptr)}};
    json["hours"] = duration_h(design.plan);
    json["u_mgal"] = design.errors.u_unknown.value();
    json["stations"] = result::json_array(station_columns(), design.errors.stations);
    json["differences"] = result::json_array(difference_columns(), design.errors.differences);
    json["alternatives"] = result::json_array(alternative_columns(), design.alternatives);
    return text::json_text(json, 2) + '\n';
}

std::string design_text(const Design& design) {
    const whole_day::DayNoise& noise = design.unit.noise;
    const unit::ScaleShare& share = design.unit.priors.scale_share;
    std::string text = fmt::format(
        "{} visits of {} stations ({} known), {} set-ups, {} h\n"
        "unit: {}; placement {}, flicker {}, white noise {} mGal; share of the scale in its errors "
        "{}\n\n",
        design.plan.size(), design.errors.stations.size(), count_known(design),
        count_set_ups(design), text::fixed(duration_h(design.plan), 1), design.unit.origin,
        text::fixed(noise.placement_mgal, 2), text::fixed(noise.flicker_mgal, 2),
        text::fixed(noise.white_mgal, 2),
        share.is_measured
            ? fmt::format("{} +- {}", text::fixed(share.mean, 2), text::fixed(share.deviation, 2))
            : "not known");
    text += result::aligned_text(result::table_of(station_columns(), design.errors.stations));
    text += fmt::format("\nexpected standard uncertainty of the unknown stations (rms): {} mGal\n",
                        text::fixed(design.errors.u_unknown.value(), 2));
    if (design.alternatives.empty())
        return text + "\nno change that was tried improves it by 1 % or more\n";
    text += "\nwhat would improve it, the best first:\n";
    for (const Alternative& one : design.alternatives) text += "  " + one.text + '\n';
    return text;
}

}  // namespace a351::corrector::design
