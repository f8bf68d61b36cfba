#pragma once
/// @file
/// The readings of a survey as they act on gravities alone, to be added to another adjustment.
///
/// With r the misclosures of the readings about approximate gravities, A_s and A_t the columns of
/// stations and terms, and all of them divided by the standard deviations of the rows,
///
///     Z = [ A_s  r ],   products = Z'Z - Z'A_t (A_t'A_t)^-1 A_t'Z
///
/// The priors of the terms are rows as well.  References are not: the adjustment that takes the block
/// holds them.
///
///     const auto block = helmert_block(adjusted);
///     // products = [ N  b ]   of the normal equations N (g - g1) = b of the gravities g
///     //            [ b' c ]
///
/// Source: F. R. Helmert, Die mathematischen und physikalischen Theorieen der hoeheren Geodaesie, vol. 1,
/// Teubner 1880, p. 556; H. Wolf, The Helmert block method, Proc. 2nd Int. Symp. Redefinition of North
/// American Geodetic Networks, 319-326, 1978.

#include <Eigen/Core>
#include <optional>

#include "corrector/adjustment/survey_equations.hpp"

namespace a351::corrector::adjustment {

/// Reduced normal equations of a survey.
struct HelmertBlock {
    Eigen::VectorXd gravities_mgal;  ///< (stations) g1, as SurveyEquations::stations().
    /// (stations + 1, stations + 1) mGal^-2; the last one is without a unit.
    Eigen::MatrixXd products;
};

/// Returns the block of a survey.
///
/// Accuracy (days_oracle_test.cpp): 80 random adjustments with up to two blocks, 500 with A351_LONG,
/// agree with plain rows within 1e-8 mGal; without a reference within 1e-6 mGal.
/// @param adjusted  determined, with unknown stations.
/// @return std::nullopt if the readings do not determine a term even with all gravities known.
[[nodiscard]] std::optional<HelmertBlock> helmert_block(const AdjustedSurvey& adjusted);

}  // namespace a351::corrector::adjustment
