#include "corrector/job/reference_survey.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/reduction/row_reduction.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::job {
namespace {

/// Value of a station in the gravimeters' network.
struct ReferenceValue {
    MilliGal gravity, u;
};

std::optional<ReferenceValue> value_of(const model::NetworkAdjustment& network,
                                       const std::string& site) {
    const auto found = std::ranges::find(network.stations, site);
    if (found == network.stations.end()) return std::nullopt;
    const auto at = found - network.stations.begin();
    return ReferenceValue{network.origin + MilliGal(network.unknowns(at)),
                          MilliGal(std::sqrt(network.covariance(at, at)))};
}

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
            row.u_reference = MilliGal(model::kLeastSd_mgal);
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

model::NetworkAdjustment hold_reference_values(const SurveyFile& survey,
                                               reading::OccupationRows& read) {
    const ReferenceSurvey& reference = survey.reference.value();
    const std::string origin = reference.observations.string();
    std::vector<reading::SurveyRow> rows =
        reading::read_observations(reference.observations, read.sites);
    if (rows.front().instrument.empty())
        throw InputError(origin + ":1: no column instrument; allowed: a table of gravimeters");
    tide::Choice tide = survey.tide;
    if (rows.front().given_tide) tide::set_tide_option(tide, "given");
    tide::apply_tide(rows, read.sites, tide);
    reduction::ReductionChoice reduction = survey.reduction;
    reduction.height.reset();  // that of the sensor
    const std::vector<text::Message> reduced = reduction::reduce_rows(
        rows, read.sites, reduction::read_gradients(survey.sites), reduction);
    read.warnings.insert(read.warnings.end(), reduced.begin(), reduced.end());
    const bool is_level_known = has_published_gravity(rows);
    if (!is_level_known) hold_level_of_sensor(rows, read, origin);
    std::vector<bool> in_use;
    for (const reading::SurveyRow& row : rows) in_use.push_back(!row.is_flagged);
    model::NetworkResult adjusted =
        model::adjust_network(rows, in_use, {}, reference.priors, reference.network);
    if (!adjusted.adjustment)
        throw InputError(fmt::format("{}: {}; allowed: {}", origin, adjusted.refusal.trouble,
                                     adjusted.refusal.allowed));
    for (reading::SurveyRow& row : read.rows)
        if (const auto value = value_of(*adjusted.adjustment, row.site)) {
            row.reference = value->gravity;
            row.u_reference = value->u;
        }
    for (text::Site& site : read.sites)
        if (const auto value = value_of(*adjusted.adjustment, site.name)) {
            site.gravity = value->gravity;
            site.u_gravity = value->u;
        }
    adjusted.adjustment->is_level_known = is_level_known;
    return std::move(*adjusted.adjustment);
}

void compare_with_reference(model::SurveyCorrection& result,
                            const model::NetworkAdjustment& reference) {
    model::SideBySide side_by_side;
    side_by_side.is_level_known = reference.is_level_known;
    side_by_side.reading_count = reference.reading_count;
    side_by_side.s0 = reference.s0();
    double relative = 0.0;
    for (const model::NetworkScale& scale : reference.scales) {
        const auto at = std::ssize(reference.stations) + static_cast<Eigen::Index>(scale.term);
        const model::ScaleEstimate estimate{scale.instrument, 1.0 + reference.unknowns(at),
                                            std::sqrt(reference.covariance(at, at)), scale.prior};
        // Several gravimeters: the best one determines what is not known of their common scale.
        relative = side_by_side.scales.empty() ? estimate.u : std::min(relative, estimate.u);
        side_by_side.scales.push_back(estimate);
    }
    for (model::ScaleEstimate& scale : result.scales) scale.u = std::hypot(scale.u, relative);
    const auto constant =
        std::ranges::find(result.coefficients, "constant_mgal", &model::Coefficient::name);
    if (side_by_side.is_level_known && constant != result.coefficients.end())
        side_by_side.bias = *constant;
    for (const model::StationValue& station : result.stations) {
        const auto theirs = value_of(reference, station.site);
        if (!theirs || !station.left_out || !station.u_left_out) continue;
        side_by_side.stations.push_back(
            {station.site, *station.left_out, *station.u_left_out, theirs->gravity, theirs->u});
    }
    result.side_by_side = std::move(side_by_side);
}

}  // namespace a351::corrector::job
