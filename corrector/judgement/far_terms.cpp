#include "corrector/judgement/far_terms.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "protocol/core/sensor_limits.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

/// Factors of a prior's standard deviation.  Reason: a free coefficient may be a hundred deviations
/// away, and one that is held moves by a thousandth of one.
constexpr double kFree = 1e2, kHeld = 1e-3;

/// Bias that is not believed.  Reason: twice the 7 mg that the data sheet allows after a year
/// (sensor_limits.hpp).
constexpr StandardGravity kFarBias(0.014);

adjustment::Priors with_factor(adjustment::Priors priors,
                               const std::vector<model::Coefficient>& terms, double factor,
                               const auto& is_chosen) {
    for (const model::Coefficient& term : terms)
        if (is_chosen(term)) priors.factors[term.name] = factor;
    return priors;
}

/// Returns "the scale of CG-5 40888", or the name of another coefficient.
text::Message name_of(const model::Fit& fit, const model::Coefficient& term) {
    if (!term.name.starts_with(adjustment::kScale)) return text::Message(term.name);
    std::size_t number = 0;
    for (const model::Coefficient& one : fit.coefficients) {
        if (one.name == term.name) break;
        if (one.name.starts_with(adjustment::kScale)) ++number;
    }
    const std::string& instrument = fit.scales.at(number).instrument;
    return instrument.empty() ? text::message("the scale of the sensor")
                              : text::message("the scale of {}", instrument);
}

}  // namespace

std::vector<model::Coefficient> far_terms(const model::Fit& fit) {
    std::vector<model::Coefficient> terms;
    std::ranges::copy_if(
        fit.coefficients, std::back_inserter(terms),
        [](const model::Coefficient& term) { return term.deviations() > kFarTerm; });
    return terms;
}

adjustment::Priors freed(adjustment::Priors priors, const std::vector<model::Coefficient>& terms) {
    return with_factor(std::move(priors), terms, kFree, [](const model::Coefficient& term) {
        return !term.name.starts_with(adjustment::kScale) ||
               std::abs(term.value - 1.0) <= adjustment::kGreatestScaleError;
    });
}

bool is_held(const model::Coefficient& term, const adjustment::Priors& given) {
    return term.name.starts_with(adjustment::kScale) || given.find(term.name) != nullptr;
}

adjustment::Priors held(adjustment::Priors given, const std::vector<model::Coefficient>& terms) {
    return with_factor(given, terms, kHeld,
                       [&](const model::Coefficient& term) { return is_held(term, given); });
}

reading::Finding far_term(const model::Fit& fit, const model::Coefficient& term,
                          const adjustment::Priors& given) {
    reading::Finding finding{.kind = reading::FindingKind::scale, .code = "term_far_from_prior"};
    finding.text = text::message(
        "{} comes out as {}, {} standard deviations from its prior {} +- {}{}: look for a mistake "
        "in the readings, or give the instrument's own value as prior",
        name_of(fit, term), text::fixed(term.value, 5), text::fixed(term.deviations(), 1),
        text::shortest(term.prior->mean), text::shortest(term.prior->sd),
        is_held(term, given) ? text::message(", and is held there") : text::Message());
    return finding;
}

std::optional<reading::Finding> far_bias(const std::vector<model::CorrectedRow>& rows) {
    std::vector<double> biases_mgal;
    for (const model::CorrectedRow& row : rows)
        if (row.row.reference && is_norm_believable(to_standard_gravity(row.row.measured())))
            biases_mgal.push_back((row.row.reduced() - *row.row.reference).value() * row.row.face);
    if (biases_mgal.empty()) return std::nullopt;
    const double bias_mgal = signal::median(std::move(biases_mgal));
    if (!(std::abs(bias_mgal) > to_milligal(kFarBias).value())) return std::nullopt;
    reading::Finding finding{
        .kind = reading::FindingKind::scale, .code = kFarBiasCode, .is_headline = true};
    finding.text = text::message(
        "the bias of the readings comes out as {} mGal, more than twice what the data sheet allows "
        "(7 mg): check their unit, and the sensitivity in the metadata",
        text::fixed(bias_mgal, 0));
    return finding;
}

text::Message held_term(const model::Fit& fit, const model::Coefficient& term) {
    return text::message(
        "{} is held at its prior {}: with the mistakes that were found it comes out as {}",
        name_of(fit, term), text::shortest(term.prior->mean), text::fixed(term.value, 5));
}

}  // namespace a351::corrector::judgement
