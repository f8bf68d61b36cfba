#pragma once
/// @file
/// The network: one adjustment of all readings for unknown stations, known stations and instrument.
///
/// Its unknowns are the gravities of all stations, for each loop a constant and a drift, and for each
/// instrument a scale; its references have their uncertainty (corrector/adjustment).  The temperature
/// takes part if it varies or has a prior, its rate only with a prior.
///
/// Use it to find many unknown stations from repeated readings and a few known ones.  A station
/// read once gets a value, but no error of its reading can be found.
///
///     const NetworkResult result = adjust_network(rows, in_use, {.datum = {"No.0"}});
///     if (!result.adjusted) return result.refusal.trouble;
///     result.adjusted->gravity(0);     // of result.adjusted->survey.stations()[0]
///
/// All functions are pure and deterministic.  Methods: corrector/methods.md, "Networks".

#include <optional>
#include <vector>

#include "corrector/adjustment/survey_equations.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/model/refusal.hpp"

namespace a351::corrector::model {

/// An adjusted network, or the reason why there is none.
struct NetworkResult {
    std::optional<adjustment::AdjustedSurvey> adjusted;  ///< Absent: see `refusal`.
    NetworkPart part;                                    ///< Rows and global test.
    std::vector<text::Message> remarks;                  ///< Facts that the user must know.
    Refusal refusal;                                     ///< Empty if there is an adjustment.
};

/// Adjusts a network.
///
/// The global test compares v^T W v with the chi-square distribution of `dof` degrees of freedom.
/// It fails above the upper limit only (kGlobalTestAlpha); nothing is scaled then.
///
/// Remarks name a temperature that is left out, stations that only the drift connects with a datum, and
/// readings with a redundancy below kControlledRedundancy.
///
/// Accuracy (network_test.cpp): made-up readings with a quadratic drift give back gravity within
/// 1e-9 mGal, drift terms within 1e-9 of their unit, and the temperature coefficient within
/// 1e-8 mGal/degC.  The redundancies of all rows add up to dof.
/// @param rows     (n) in ascending time, at least one; finite; kept by reference.
/// @param in_use   (n); a row in use needs no reference.
/// @param options  datum, priors, steps and network.  A name of the datum without a reading in use has
///                 no effect.
/// @return a refusal if no reading is in use, if no station is held, if a listed station has no
///         reference, if stations have no connection with a datum, or if the readings do not
///         determine an unknown.
[[nodiscard]] NetworkResult adjust_network(const std::vector<reading::SurveyRow>& rows,
                                           const std::vector<bool>& in_use,
                                           const SurveyOptions& options);

}  // namespace a351::corrector::model
