#include "corrector/adjustment/term.hpp"

#include <fmt/core.h>

namespace a351::corrector::adjustment {
namespace {

const reading::RecordSummary& axes_of(const TermInput& in) {
    return in.row.axes_for(fmt::format("model = {}", in.wanted_by));
}

}  // namespace

const Term kConstant{"constant_mgal", Correction::temperature, Scope::loop,
                     [](const TermInput&) { return 1.0; }};
const Term kTime{"time_mgal_per_h", Correction::drift, Scope::loop,
                 [](const TermInput& in) { return in.hours; }};
const Term kTime2{"time2_mgal_per_h2", Correction::drift, Scope::loop,
                  [](const TermInput& in) { return in.hours * in.hours; }};
const Term kTime3{"time3_mgal_per_h3", Correction::drift, Scope::loop,
                  [](const TermInput& in) { return in.hours * in.hours * in.hours; }};
const Term kTemperature{
    "temperature_mgal_per_degc", Correction::temperature, Scope::unit,
    [](const TermInput& in) { return (in.row.temperature - kReferenceTemperature).value(); }};
const Term kRate{"rate_mgal_per_degc_per_h", Correction::rate, Scope::unit,
                 [](const TermInput& in) { return in.row.rate_degc_per_h; }};
const Term kAxisX{"x_mgal_per_g", Correction::tilt, Scope::unit,
                  [](const TermInput& in) { return axes_of(in).x.mean.value(); }};
const Term kAxisY{"y_mgal_per_g", Correction::tilt, Scope::unit,
                  [](const TermInput& in) { return axes_of(in).y.mean.value(); }};
const Term kAdmittance{
    "admittance_mgal_per_hpa", Correction::pressure, Scope::unit,
    [](const TermInput& in) { return in.row.excess_pressure_hpa.value_or(0.0); }};
const Term kScaleTerm{kScale, Correction::scale, Scope::unit, nullptr};

std::span<const Term* const> terms_with_prior() {
    static const std::array kList{&kTemperature, &kRate, &kTime, &kScaleTerm};
    return kList;
}

}  // namespace a351::corrector::adjustment
