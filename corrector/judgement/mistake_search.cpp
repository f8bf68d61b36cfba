#include "corrector/judgement/mistake_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "corrector/judgement/mistake_trial.hpp"

namespace a351::corrector::judgement {
namespace {

/// Mistakes that are put right on trial although they are not sure.  Reason: two large ones hide each
/// other, until both are put right (the generalised test of B. Rosner, Technometrics 25, 165-172,
/// 1983).
constexpr std::size_t kLookAhead = 2;

/// Returns the residuals with the known mistakes put right, for the noise of the survey in which the
/// mistakes of `quiet` are put right; std::nullopt if the model does not fit that survey.
std::optional<Trial> trial_of(adjustment::Trials& trials,
                              const std::vector<SearchedReading>& readings,
                              const std::vector<Mistake>& known,
                              const std::vector<Mistake>& quiet) {
    auto residuals = trials.residuals({known.begin(), known.end()}, {quiet.begin(), quiet.end()});
    if (!residuals) return std::nullopt;
    return Trial(std::move(residuals), readings, known);
}

/// Returns the mistakes and a further one.
std::vector<Mistake> with(std::vector<Mistake> mistakes, const Mistake& further) {
    mistakes.push_back(further);
    return mistakes;
}

/// Returns the mistake that explains most of the remaining scatter, with its probability.
///
/// A mistake makes the noise of the survey larger and may then be taken for another one.  Therefore
/// the best few are each tried at the noise of the survey in which they are put right.  There the
/// right one is clear.
std::optional<Mistake> next_mistake(const std::vector<SearchedReading>& readings,
                                    adjustment::Trials& trials, const std::vector<Mistake>& known,
                                    bool is_known_sure, double alpha) {
    constexpr std::size_t kTried = 4;
    const auto noisy = trial_of(trials, readings, known, known);
    if (!noisy || !noisy->is_possible() || !(is_known_sure || noisy->allows_trial()))
        return std::nullopt;
    const std::vector<Scored> candidates = noisy->best(kTried);
    std::vector<std::vector<adjustment::Alternative>> quiets;
    for (const Scored& candidate : candidates)
        quiets.emplace_back(known.begin(), known.end()).push_back(candidate.mistake);
    trials.expect(quiets);
    std::optional<Scored> best;
    for (const Scored& candidate : candidates) {
        const auto trial = trial_of(trials, readings, known, with(known, candidate.mistake));
        if (!trial || !trial->is_possible()) continue;
        Scored found = trial->best(1).front();
        if (!best || found.score > best->score) best = std::move(found);
    }
    if (!best) return std::nullopt;
    const auto trial = trial_of(trials, readings, known, with(known, best->mistake));
    if (!trial) return std::nullopt;
    trial->measure(best->mistake, is_known_sure ? alpha : kTrialShare * alpha);
    return best->mistake;
}

/// Returns the level that the probability of a mistake must not exceed.
double level_of(const Mistake& mistake, double alpha) {
    return mistake.needed_trial ? kTrialShare * alpha : alpha;
}

double share_of_level(const Mistake& mistake, double alpha) {
    return mistake.p / level_of(mistake, alpha);
}

/// Returns true for a mistake that is unlikely without one, and large enough to be read.
bool is_clear(const Mistake& mistake, double alpha) {
    return share_of_level(mistake, alpha) <= 1.0 &&
           std::abs(mistake.size_mgal) >= kLeastSize_u * mistake.u_mgal;
}

std::vector<Mistake> without(std::vector<Mistake> mistakes, std::size_t k) {
    mistakes.erase(mistakes.begin() + static_cast<std::ptrdiff_t>(k));
    return mistakes;
}

/// Replaces each mistake by the one that explains most of the scatter left by the others, because
/// one may have been taken for two at first.
void refine(std::vector<Mistake>& mistakes, const std::vector<SearchedReading>& readings,
            adjustment::Trials& trials) {
    for (std::size_t k = 0; k < mistakes.size(); ++k) {
        const std::vector<Mistake> others = without(mistakes, k);
        const auto trial = trial_of(trials, readings, others, mistakes);
        if (trial && trial->is_possible()) mistakes[k] = trial->best(1).front().mistake;
    }
}

/// Returns true if the mistakes after the first `sure` ones explain together more than they cost.
///
/// Reason: two that cancel each other leave as much as none, and each is clear while the other one is
/// put right.
bool explain_together(const std::vector<Mistake>& mistakes, std::size_t sure,
                      const std::vector<SearchedReading>& readings, adjustment::Trials& trials) {
    const auto middle = mistakes.begin() + static_cast<std::ptrdiff_t>(sure);
    const std::vector<Mistake> known(mistakes.begin(), middle), further(middle, mistakes.end());
    const auto before = trial_of(trials, readings, known, mistakes);
    const auto after = trial_of(trials, readings, mistakes, mistakes);
    return before && after && before->gain_of(*after, further) > 0.0;
}

/// Sets probabilities, sizes and uncertainties again, each from the residuals with the others put right.
void measure_again(std::vector<Mistake>& mistakes, const std::vector<SearchedReading>& readings,
                   adjustment::Trials& trials, double alpha) {
    for (std::size_t k = 0; k < mistakes.size(); ++k) {
        const auto trial = trial_of(trials, readings, without(mistakes, k), mistakes);
        mistakes[k].p = 1.0;
        if (!trial) continue;
        Mistake mistake = mistakes[k];
        trial->measure(mistake, level_of(mistake, alpha));
        mistakes[k].p = mistake.p;
        mistakes[k].size_mgal = mistake.size_mgal;
        mistakes[k].u_mgal = mistake.u_mgal;
    }
}

}  // namespace

std::vector<Mistake> search_mistakes(const std::vector<SearchedReading>& readings,
                                     adjustment::Trials& trials, double alpha) {
    std::vector<Mistake> mistakes;
    const auto accepted =
        static_cast<std::size_t>(std::ranges::count(readings, true, &SearchedReading::is_accepted));
    std::vector<Mistake> sure;
    while (mistakes.size() < std::min(accepted / 3, sure.size() + 1 + kLookAhead)) {
        const bool is_known_sure = mistakes.size() == sure.size();
        auto found = next_mistake(readings, trials, mistakes, is_known_sure, alpha);
        if (!found) break;
        found->needed_trial = !is_known_sure;
        const bool is_sure = is_clear(*found, alpha);
        mistakes.push_back(std::move(*found));
        if (mistakes.size() > 1) refine(mistakes, readings, trials);
        if (!is_sure ||
            (!is_known_sure && !explain_together(mistakes, sure.size(), readings, trials)))
            continue;
        for (std::size_t k = 0; k < mistakes.size(); ++k)
            mistakes[k].needed_trial = k < sure.size() ? sure[k].needed_trial : !is_known_sure;
        sure = mistakes;
    }
    drop_unclear(sure, readings, trials, alpha);
    return sure;
}

void drop_unclear(std::vector<Mistake>& mistakes, const std::vector<SearchedReading>& readings,
                  adjustment::Trials& trials, double alpha) {
    while (!mistakes.empty()) {
        measure_again(mistakes, readings, trials, alpha);
        const auto worst = std::ranges::max_element(mistakes, {}, [&](const Mistake& one) {
            return std::pair(!is_clear(one, alpha), share_of_level(one, alpha));
        });
        if (is_clear(*worst, alpha)) break;
        mistakes.erase(worst);
    }
}

}  // namespace a351::corrector::judgement
