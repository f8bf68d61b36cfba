#pragma once
/// @file
/// Coefficients that the readings move far from their priors: a prior that is wrong, or a mistake in
/// the readings that looks like a scale.

#include <optional>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/finding.hpp"

namespace a351::corrector::judgement {

/// Distance of a coefficient from the mean of its prior that is not believed, in standard deviations
/// of the prior.  Reason: a normal prior that is right allows it less than once in 16 000.
inline constexpr double kFarTerm = 4.0;

/// Returns the coefficients that are farther than kFarTerm from their priors.
[[nodiscard]] std::vector<model::Coefficient> far_terms(const model::Fit& fit);

/// Returns the priors with the coefficients free, so that the readings alone decide.  A scale farther
/// from 1 than adjustment::kGreatestScaleError keeps its prior: it is no scale.
[[nodiscard]] adjustment::Priors freed(adjustment::Priors priors,
                                       const std::vector<model::Coefficient>& terms);

/// Returns true for a coefficient that is held when it is far: a scale, or one whose prior the user gave.
/// Other priors are assumptions about a unit that nobody has measured; clear readings overrule them.
[[nodiscard]] bool is_held(const model::Coefficient& term, const adjustment::Priors& given);

/// Returns the given priors with the coefficients of is_held() held at their means.  Their standard
/// deviations still count in all uncertainties.
[[nodiscard]] adjustment::Priors held(adjustment::Priors given,
                                      const std::vector<model::Coefficient>& terms);

/// Returns a finding of the kind `scale`.
/// @param fit    with the coefficient.
/// @param given  priors of the user.
[[nodiscard]] reading::Finding far_term(const model::Fit& fit, const model::Coefficient& term,
                                        const adjustment::Priors& given);

/// Code of the finding of far_bias().
inline constexpr const char* kFarBiasCode = "far_bias";

/// Returns a finding of the kind `scale` if readings near 1 g are farther from their references
/// than any bias explains: they have another unit, or the sensitivity is wrong.  Other readings are
/// those of a gravimeter with an offset of its own.
[[nodiscard]] std::optional<reading::Finding> far_bias(
    const std::vector<model::CorrectedRow>& rows);

/// Returns a remark: the coefficient is held at its prior, because mistakes moved it away.
[[nodiscard]] text::Message held_term(const model::Fit& fit, const model::Coefficient& term);

}  // namespace a351::corrector::judgement
