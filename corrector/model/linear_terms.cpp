#include "corrector/model/linear_terms.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace a351::corrector::model {
namespace {

using reading::SurveyRow;

const reading::RecordSummary& axes_of(const LinearModel& model, const SurveyRow& row) {
    return row.axes_for(fmt::format("model = {}", model.name));
}

const std::array kTerms{
    LinearTerm{&LinearModel::has_temperature, "temperature_mgal_per_degc",
               [](const LinearModel&, const SurveyRow& row, const TimeOrigin&) {
                   return (row.temperature - kReferenceTemperature).value();
               },
               [](CorrectedRow& row, MilliGal effect) {
                   row.temperature_correction = row.temperature_correction - effect;
               }},
    LinearTerm{&LinearModel::has_rate, "rate_mgal_per_degc_per_h",
               [](const LinearModel&, const SurveyRow& row, const TimeOrigin&) {
                   return row.rate_degc_per_h;
               },
               [](CorrectedRow& row, MilliGal effect) { row.rate_correction = -effect; }},
    LinearTerm{&LinearModel::has_time, "time_mgal_per_h",
               [](const LinearModel&, const SurveyRow& row, const TimeOrigin& origin) {
                   return seconds_between(origin.time, row.time) / kSecondsPerHour -
                          kReferenceTime_h;
               },
               [](CorrectedRow& row, MilliGal effect) { row.drift_correction = -effect; }},
    LinearTerm{&LinearModel::has_axes, "x_mgal_per_g",
               [](const LinearModel& model, const SurveyRow& row, const TimeOrigin&) {
                   return axes_of(model, row).x.mean.value();
               },
               [](CorrectedRow& row, MilliGal effect) { row.tilt_correction = -effect; }},
    LinearTerm{&LinearModel::has_axes, "y_mgal_per_g",
               [](const LinearModel& model, const SurveyRow& row, const TimeOrigin&) {
                   return axes_of(model, row).y.mean.value();
               },
               [](CorrectedRow& row, MilliGal effect) {
                   row.tilt_correction = row.tilt_correction_or_zero() - effect;
               }},
    LinearTerm{&LinearModel::has_scale, kScale,
               [](const LinearModel&, const SurveyRow& row, const TimeOrigin&) {
                   return row.reference.value_or(row.acceleration - row.tide).value() -
                          kMilliGalPerStandardGravity;
               },
               [](CorrectedRow& row, MilliGal effect) { row.scale_correction = -effect; }},
};

}  // namespace

std::vector<LinearTerm> terms_of(const LinearModel& model) {
    std::vector<LinearTerm> terms;
    std::ranges::copy_if(kTerms, std::back_inserter(terms),
                         [&](const LinearTerm& term) { return model.*term.is_in; });
    return terms;
}

}  // namespace a351::corrector::model
