#pragma once
/// @file
/// Search for mistakes of the field in the residuals of a survey: readings that are off, references
/// that are wrong, names that were swapped, steps of the instrument.
///
///     std::vector<SearchedReading> readings = ...;      // in order of time
///     const auto mistakes = search_mistakes(readings, *trials);
///
/// The search takes one mistake after another, each time the one that explains most.  It compares
/// them by the scatter that is left, with a penalty for an unknown size and for the number of its
/// class.  A mistake is kept if fewer than `alpha` of simulated surveys without one contain
/// anything as clear.
///
/// Method: corrector/methods.md, "Search for mistakes".  False alarms and power: accuracy.md.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "corrector/adjustment/trials.hpp"

namespace a351::corrector::judgement {

/// A mistake that was found: an alternative to the survey, with its size.
struct Mistake : adjustment::Alternative {
    double u_mgal = 0.0;  ///< Standard uncertainty; 0 for a swap.
    /// Probability that a survey without a mistake shows one of any kind as clear as this.
    double p = 1.0;
    /// It was sure only when another one was put right on trial; then `p` is somewhat too small.
    bool needed_trial = false;
};

/// A reading of the survey, as the search sees it.
struct SearchedReading {
    std::string site;
    int occupation = 1;
    /// Reference that the fit holds, mGal; absent: the station is unknown.
    std::optional<double> reference_mgal;
    bool is_accepted = true;  ///< False: it is outside the fit, and no mistake.
    std::size_t loop = 0;     ///< Readings of one loop have a constant in common.
    int face = 1;             ///< As reading::SurveyRow::face.
};

/// Greatest p of a headline.  Reason: one clean day in a thousand may be told something false in its
/// first line.
inline constexpr double kHeadlineP = 0.001;
/// Least size of a mistake that is reported, in its standard uncertainties.
inline constexpr double kLeastSize_u = 3.0;

/// Probability that a mistake is found where there is none.
inline constexpr double kMistakeAlpha = 0.02;
/// The same in the residuals of the whole-day model.  Reason: its lags and noise are estimated from
/// the same day, so small probabilities are too small; 2 % of them are found on 5 % of the days
/// (corrector/methods.md).
inline constexpr double kWholeDayMistakeAlpha = 0.012;
/// Share of the probability that is left for a mistake that is sure only when another one was put
/// right on trial.  Reason: there are two such searches, which may add a fifth to the false alarms;
/// large mistakes that hid each other are far below it.
inline constexpr double kTrialShare = 0.1;

/// Returns the mistakes that were found, in the order in which they were.
///
/// It ends when nothing more is found, also not with two more put right on trial, or when there are a
/// third as many mistakes as readings.  A mistake that is no longer visible when the others are put
/// right is dropped.  The simulations have a fixed seed.
/// @param readings     in order of time.
/// @param trials    of the survey; asked about ten times for each mistake.
/// @param alpha        probability that a mistake is found where there is none.
[[nodiscard]] std::vector<Mistake> search_mistakes(const std::vector<SearchedReading>& readings,
                                                   adjustment::Trials& trials,
                                                   double alpha = kMistakeAlpha);

/// Measures mistakes again and drops those that are no longer clear with the others put right, the
/// least clear first.
/// @param mistakes  from search_mistakes().
void drop_unclear(std::vector<Mistake>& mistakes, const std::vector<SearchedReading>& readings,
                  adjustment::Trials& trials, double alpha);

}  // namespace a351::corrector::judgement
