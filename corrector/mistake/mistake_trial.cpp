#include "corrector/mistake/mistake_trial.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace a351::corrector::mistake {
namespace {

using Index = Eigen::Index;

/// Range of the size of a mistake, mGal.  Reason: benchmarks of a survey lie within tens of mGal, and
/// so do slips in a table.
constexpr double kSizeRange_mgal = 100.0;
/// Largest range, in the median uncertainty of a size.  At 0.5 mGal it is kSizeRange_mgal.
/// Reason: a gravimeter of 0.005 mGal has no slips of 100 mGal.  With that range a step would have
/// to be twice as large to be preferred to a swap, whose cost has no range.
constexpr double kLargestSize_u = 200.0;
/// Least degrees of freedom of the scatter.  Reason: with fewer, everything is explained.
constexpr double kFewestDof = 4.0;
/// The same, when a mistake that is not sure is put right on trial and a further one is searched for.
/// Assumed: each of them takes one degree of freedom, and more than kFewestDof must be left.
constexpr double kFewestTrialDof = 8.0;
/// Simulated surveys: first enough to see that nothing is found, then to know a small probability.
constexpr int kFewDraws = 500, kManyDraws = 20000;

/// Returns the effect of 1 mGal in some of the readings.
Eigen::VectorXd effect_of(const std::vector<std::size_t>& readings, std::size_t count) {
    Eigen::VectorXd effect = Eigen::VectorXd::Zero(static_cast<Index>(count));
    for (const std::size_t i : readings) effect(static_cast<Index>(i)) = 1.0;
    return effect;
}

/// The stays of a survey: readings of one site and occupation.
struct Stay {
    std::string site;
    std::vector<std::size_t> readings;
    std::optional<double> reference_mgal;
};

std::vector<Stay> stays_of(const std::vector<SearchedReading>& readings) {
    std::vector<Stay> stays;
    std::map<std::pair<std::string, int>, std::size_t> places;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const SearchedReading& reading = readings[i];
        if (!reading.is_accepted) continue;
        const auto [place, is_new] =
            places.emplace(std::pair(reading.site, reading.occupation), stays.size());
        if (is_new) stays.push_back({reading.site, {}, reading.reference_mgal});
        stays[place->second].readings.push_back(i);
    }
    return stays;
}

/// Returns all mistakes that there may be, without sizes.
std::vector<Mistake> possible_mistakes(const std::vector<SearchedReading>& readings) {
    std::vector<Mistake> list;
    const auto add = [&list](MistakeKind kind, std::vector<std::size_t> numbers) {
        Mistake& mistake = list.emplace_back();
        mistake.kind = kind;
        mistake.readings = std::move(numbers);
    };
    const std::vector<Stay> stays = stays_of(readings);
    std::map<std::string, std::vector<std::size_t>> stations;
    std::map<std::string, std::size_t> stay_counts;
    for (const Stay& stay : stays) {
        auto& of_station = stations[stay.site];
        of_station.insert(of_station.end(), stay.readings.begin(), stay.readings.end());
        ++stay_counts[stay.site];
        if (stay.readings.size() > 1)
            for (const std::size_t i : stay.readings) add(MistakeKind::set_up, {i});
    }
    for (const Stay& stay : stays)
        if (stay_counts[stay.site] > 1) add(MistakeKind::stay, stay.readings);
    // Without a reference all readings of a station are off by nothing that anybody could notice.
    for (const auto& [site, numbers] : stations)
        if (readings[numbers.front()].reference_mgal) add(MistakeKind::station, numbers);
    for (std::size_t a = 0; a < stays.size(); ++a)
        for (std::size_t b = a + 1; b < stays.size(); ++b) {
            if (!stays[a].reference_mgal || !stays[b].reference_mgal) continue;
            // Readings of b under the name of a are too high by the difference.
            add(MistakeKind::swap, stays[a].readings);
            list.back().others = stays[b].readings;
            list.back().size_mgal = *stays[b].reference_mgal - *stays[a].reference_mgal;
        }
    std::map<std::size_t, std::vector<std::size_t>> stays_of_loops;
    for (std::size_t k = 0; k < stays.size(); ++k)
        stays_of_loops[readings[stays[k].readings.front()].loop].push_back(k);
    for (const auto& [loop, numbers] : stays_of_loops) {
        // A step with one stay before or after it is the same as this stay being off.
        if (numbers.size() < 4) continue;
        const std::size_t first = stays[numbers[2]].readings.front(),
                          last = stays[numbers[numbers.size() - 2]].readings.front();
        for (std::size_t i = first; i <= last; ++i) {
            if (!readings[i].is_accepted || readings[i].loop != loop) continue;
            std::vector<std::size_t> after;
            for (std::size_t k = i; k < readings.size(); ++k)
                if (readings[k].loop == loop) after.push_back(k);
            add(MistakeKind::step, std::move(after));
        }
    }
    return list;
}

/// Returns true for a swap of a stay that is known to be off: the other stay alone is then no sign.
bool is_half_known(const Mistake& mistake, const std::vector<Mistake>& known) {
    if (mistake.kind != MistakeKind::swap) return false;
    return std::ranges::any_of(known, [&](const Mistake& one) {
        if (one.kind == MistakeKind::step) return false;
        const auto is_known = [&](std::size_t i) {
            return std::ranges::count(one.readings, i) + std::ranges::count(one.others, i) > 0;
        };
        return std::ranges::any_of(mistake.readings, is_known) ||
               std::ranges::any_of(mistake.others, is_known);
    });
}

/// Finds those of which the residuals contain something, with their directions.
std::vector<Suspect> suspects_of(const residual::Residuals& residuals,
                                 const std::vector<SearchedReading>& readings,
                                 const std::vector<Mistake>& known, Directions& directions) {
    std::vector<Eigen::VectorXd> effects;
    std::map<std::vector<std::size_t>, Index> stays;  // column of each stay's effect
    const auto add = [&effects](Eigen::VectorXd effect) {
        effects.push_back(std::move(effect));
        return std::ssize(effects) - 1;
    };
    const auto column_of = [&](const std::vector<std::size_t>& stay) {
        const auto [place, is_new] = stays.emplace(stay, 0);
        if (is_new) place->second = add(residuals.projected(effect_of(stay, readings.size())));
        return place->second;
    };
    std::vector<Suspect> suspects;
    for (Mistake& mistake : possible_mistakes(readings)) {
        if (is_half_known(mistake, known)) continue;
        Suspect suspect;
        if (mistake.kind == MistakeKind::swap) {
            suspect.direction = column_of(mistake.readings);
            suspect.other = column_of(mistake.others);
            suspect.size = mistake.size_mgal;
            suspect.length =
                std::abs(suspect.size) * (effects[static_cast<std::size_t>(suspect.direction)] -
                                          effects[static_cast<std::size_t>(suspect.other)])
                                             .norm();
        } else {
            residual::Direction direction =
                residuals.direction(effect_of(mistake.readings, readings.size()));
            suspect.length = direction.length;
            if (suspect.length > 0.0) suspect.direction = add(std::move(direction.unit));
        }
        suspect.mistake = std::move(mistake);
        if (suspect.length > 0.0) suspects.push_back(std::move(suspect));
    }
    directions.effects.resize(residuals.values.size(), std::ssize(effects));
    for (std::size_t k = 0; k < effects.size(); ++k)
        directions.effects.col(static_cast<Index>(k)) = effects[k];
    directions.scatters = residuals.to_scatter * directions.effects;
    for (Suspect& suspect : suspects) {
        const auto column = directions.scatters.col(suspect.direction);
        suspect.scatter_square =
            suspect.has_size() ? suspect.size * suspect.size *
                                     (column - directions.scatters.col(suspect.other)).squaredNorm()
                               : column.squaredNorm();
    }
    return suspects;
}

/// Returns the share of the scatter that a mistake explains, 0 to 1.
double share_of(const Suspect& suspect, const Seen& seen) {
    const double t = suspect.product(seen.values);
    const double part = suspect.has_size() ? 1.0 : t;
    const double length = suspect.has_size() ? suspect.length : 1.0;
    const double gain = part * (2.0 * t - part * length * length);
    if (!(gain > 0.0)) return 0.0;
    const double rest = seen.square - 2.0 * part * suspect.product(seen.scatters) +
                        part * part * suspect.scatter_square;
    return gain / (gain + rest);
}

/// Returns the range of the size of a mistake, mGal.
double size_range_mgal(const std::vector<Suspect>& suspects) {
    std::vector<double> lengths;
    for (const Suspect& suspect : suspects)
        if (!suspect.has_size()) lengths.push_back(suspect.length);
    if (lengths.empty()) return kSizeRange_mgal;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    return std::min(kSizeRange_mgal, kLargestSize_u / *middle);
}

/// Sets what each suspect costs: ln(number of its class), and for an unknown size what one within
/// size_range_mgal() costs.  Classes are readings and stations, swaps, steps.
void set_costs(std::vector<Suspect>& suspects) {
    const auto class_of = [](const Suspect& suspect) {
        const MistakeKind kind = suspect.mistake.kind;
        return kind == MistakeKind::swap || kind == MistakeKind::step ? kind : MistakeKind::station;
    };
    std::map<MistakeKind, double> counts;
    for (const Suspect& suspect : suspects) ++counts[class_of(suspect)];
    const double range_mgal = size_range_mgal(suspects);
    for (Suspect& suspect : suspects) {
        suspect.cost = std::log(counts[class_of(suspect)]);
        if (!suspect.has_size())
            suspect.cost +=
                std::log(range_mgal * suspect.length / std::sqrt(2.0 * std::numbers::pi));
    }
}

}  // namespace

Trial::Trial(residual::Residuals residuals, const std::vector<SearchedReading>& readings,
             const std::vector<Mistake>& known)
    : residuals_(std::move(residuals)),
      dof_(residuals_.dof()),
      suspects_(suspects_of(residuals_, readings, known, directions_)) {
    set_costs(suspects_);
}

bool Trial::is_possible() const { return !suspects_.empty() && dof_ >= kFewestDof; }

bool Trial::allows_trial() const { return dof_ >= kFewestTrialDof; }

std::vector<Scored> Trial::best(std::size_t count) const {
    const Seen seen = seen_in(residuals_.values);
    std::vector<std::pair<double, const Suspect*>> scores;
    for (const Suspect& suspect : suspects_)
        scores.emplace_back(score_of(suspect, seen), &suspect);
    std::ranges::stable_sort(scores, std::ranges::greater(),
                             &std::pair<double, const Suspect*>::first);
    std::vector<Scored> best;
    for (const auto& [score, suspect] : scores)
        if (best.size() < count) best.push_back({measured(*suspect), score});
    return best;
}

void Trial::measure(Mistake& mistake) const {
    const auto found = std::ranges::find_if(suspects_, [&](const Suspect& suspect) {
        return suspect.mistake.kind == mistake.kind &&
               suspect.mistake.readings == mistake.readings &&
               suspect.mistake.others == mistake.others;
    });
    if (found == suspects_.end()) {
        mistake.p = 1.0;
        return;
    }
    mistake = measured(*found);
    mistake.p = probability(score_of(*found, seen_in(residuals_.values)));
}

Mistake Trial::measured(const Suspect& suspect) const {
    Mistake mistake = suspect.mistake;
    if (suspect.has_size()) return mistake;
    mistake.size_mgal =
        directions_.effects.col(suspect.direction).dot(residuals_.values) / suspect.length;
    mistake.u_mgal = 1.0 / suspect.length;
    return mistake;
}

Seen Trial::seen_in(const Eigen::VectorXd& values) const {
    const Eigen::VectorXd scatter = residuals_.to_scatter * values;
    return {directions_.effects.transpose() * values, directions_.scatters.transpose() * scatter,
            scatter.squaredNorm()};
}

double Trial::score_of(const Suspect& suspect, const Seen& seen) const {
    return -0.5 * dof_ * std::log1p(-share_of(suspect, seen)) - suspect.cost;
}

/// Returns the highest score of all suspects.
double Trial::best_score(const Eigen::VectorXd& values) const {
    const Seen seen = seen_in(values);
    double best = -HUGE_VAL;
    for (const Suspect& suspect : suspects_) best = std::max(best, score_of(suspect, seen));
    return best;
}

/// Returns the probability that anything has such a score, if there is no mistake.
double Trial::probability(double score) const {
    std::mt19937_64 generator(1);  // fixed seed: the same day gives the same probability
    int higher = 0, draws = 0;
    const auto draw_until = [&](int count) {
        for (; draws < count; ++draws)
            if (best_score(residuals_.simulated(generator)) >= score) ++higher;
        return (1.0 + higher) / (1.0 + draws);
    };
    const double p = draw_until(kFewDraws);
    return p > 5.0 * kMistakeAlpha ? p : draw_until(kManyDraws);
}

}  // namespace a351::corrector::mistake
