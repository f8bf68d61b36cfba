#include "corrector/job/reference_survey.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/network.hpp"
#include "corrector/reduction/row_reduction.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::job {
namespace {

/// Gives the first common station the mean reading of the sensor there as its reference.
void hold_level_of_sensor(std::vector<reading::SurveyRow>& rows,
                          const reading::OccupationRows& read, const std::string& origin) {
    for (const reading::SurveyRow& first : rows) {
        double sum = 0.0, count = 0.0;
        for (const reading::SurveyRow& ours : read.rows) {
            if (ours.site != first.site) continue;
            sum += ours.reduced().value();
            count += 1.0;
        }
        if (count == 0.0) continue;
        for (reading::SurveyRow& row : rows) {
            if (row.site != first.site) continue;
            row.reference = MilliGal(sum / count);
            row.u_reference = MilliGal(adjustment::kLeastSd_mgal);
        }
        return;
    }
    throw InputError(origin + ": no station in common with the survey; allowed: one or more");
}

bool has_published_gravity(const std::vector<reading::SurveyRow>& rows) {
    return std::ranges::any_of(rows, [](const reading::SurveyRow& row) {
        return row.reference.has_value() && !row.is_flagged;
    });
}

}  // namespace

ReferenceNetwork hold_reference_values(const SurveyFile& survey, reading::OccupationRows& read) {
    const ReferenceSurvey& reference = survey.reference.value();
    const std::string origin = reference.observations.string();
    std::vector<reading::SurveyRow> rows =
        reading::read_observations(reference.observations, read.sites);
    if (rows.front().instrument.empty())
        throw InputError(origin + ":1: no column instrument; allowed: a table of gravimeters");
    tide::Choice tide = survey.tide;
    if (rows.front().given_tide) {
        const std::string system(tide::name_of(tide.system));
        tide::set_tide_option(tide, "given");
        tide::take_given_system(tide, rows, origin);
        tide::set_tide_system(tide, system, origin + ": tide_system of the survey");
    }
    tide::apply_tide(rows, read.sites, tide);
    tide.factors = {};  // The survey's own rows have the warning about them.
    for (const text::Message& warning : tide::tide_warnings(rows, read.sites, tide))
        read.warnings.push_back(origin + ": " + warning);
    reduction::ReductionChoice reduction = survey.reduction;
    reduction.height.reset();  // that of the sensor
    const std::vector<text::Message> reduced = reduction::reduce_rows(
        rows, read.sites, reduction::read_gradients(survey.sites), reduction);
    read.warnings.insert(read.warnings.end(), reduced.begin(), reduced.end());
    const bool is_level_known = has_published_gravity(rows);
    if (!is_level_known) hold_level_of_sensor(rows, read, origin);
    std::vector<bool> in_use;
    for (const reading::SurveyRow& row : rows) in_use.push_back(!row.is_flagged);
    const model::NetworkResult adjusted = model::adjust_network(
        rows, in_use, {.network = reference.network, .priors = reference.priors});
    if (!adjusted.adjusted)
        throw InputError(fmt::format("{}: {}; allowed: {}", origin, adjusted.refusal.trouble,
                                     adjusted.refusal.allowed));
    const adjustment::AdjustedSurvey& network = *adjusted.adjusted;
    ReferenceNetwork result;
    for (std::size_t k = 0; k < network.survey.stations().size(); ++k)
        result.values[network.survey.stations()[k].site] = {
            network.gravity(k), MilliGal(std::sqrt(network.adjustment.variance({{k, 1.0}})))};
    for (std::size_t k = 0; k < network.survey.terms().size(); ++k) {
        const adjustment::SurveyTerm& term = network.survey.terms()[k];
        const std::size_t at = network.survey.unknown_of_term(k);
        if (term.is_scale)
            result.network.scales.push_back({term.instrument, network.coefficient(k),
                                             std::sqrt(network.adjustment.variance({{at, 1.0}})),
                                             *term.prior});
    }
    result.network.reading_count = adjusted.part.reading_count;
    result.network.s0 = adjusted.part.s0();
    result.network.is_level_known = is_level_known;
    for (reading::SurveyRow& row : read.rows)
        if (const auto value = result.values.find(row.site); value != result.values.end()) {
            row.reference = value->second.gravity;
            row.u_reference = value->second.u;
        }
    for (text::Site& site : read.sites)
        if (const auto value = result.values.find(site.name); value != result.values.end()) {
            site.gravity = value->second.gravity;
            site.u_gravity = value->second.u;
        }
    return result;
}

void compare_with_reference(model::SurveyCorrection& result, const ReferenceNetwork& reference) {
    model::SideBySide side_by_side = reference.network;
    // Several gravimeters: the best one gives the unknown part of their common scale.
    double relative = HUGE_VAL;
    for (const model::ScaleEstimate& scale : side_by_side.scales)
        relative = std::min(relative, scale.u);
    if (side_by_side.scales.empty()) relative = 0.0;
    for (model::ScaleEstimate& scale : result.scales) scale.u = std::hypot(scale.u, relative);
    const auto constant =
        std::ranges::find(result.coefficients, "constant_mgal", &model::Coefficient::name);
    if (side_by_side.is_level_known && constant != result.coefficients.end())
        side_by_side.bias = *constant;
    for (const model::StationValue& station : result.stations) {
        const auto theirs = reference.values.find(station.site);
        if (theirs == reference.values.end() || !station.left_out || !station.u_left_out) continue;
        side_by_side.stations.push_back({station.site, *station.left_out, *station.u_left_out,
                                         theirs->second.gravity, theirs->second.u});
    }
    result.side_by_side = std::move(side_by_side);
}

}  // namespace a351::corrector::job
