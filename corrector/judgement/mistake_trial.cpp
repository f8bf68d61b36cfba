#include "corrector/judgement/mistake_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "protocol/signal/distributions.hpp"

namespace a351::corrector::judgement {
namespace {

using Index = Eigen::Index;
using Kind = adjustment::AlternativeKind;

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
/// Most simulated surveys.  Reason: a probability of 0.1 % is then known within a quarter.
constexpr int kMostDraws = 20000;
/// Simulated surveys between two looks whether the probability is clearly above its level.
constexpr int kDrawsEach = 50;

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
    const auto add = [&list](Kind kind, std::vector<std::size_t> numbers) {
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
            for (const std::size_t i : stay.readings) add(Kind::set_up, {i});
    }
    for (const Stay& stay : stays)
        if (stay_counts[stay.site] > 1) add(Kind::stay, stay.readings);
    // Without a reference all readings of a station are off by nothing that anybody could notice.
    for (const auto& [site, numbers] : stations)
        if (readings[numbers.front()].reference_mgal) add(Kind::station, numbers);
    for (std::size_t a = 0; a < stays.size(); ++a)
        for (std::size_t b = a + 1; b < stays.size(); ++b) {
            if (!stays[a].reference_mgal || !stays[b].reference_mgal ||
                readings[stays[a].readings.front()].loop !=
                    readings[stays[b].readings.front()].loop)
                continue;
            // Readings of b under the name of a are too high by the difference.
            add(Kind::swap, stays[a].readings);
            list.back().others = stays[b].readings;
            list.back().size_mgal = *stays[b].reference_mgal - *stays[a].reference_mgal;
        }
    std::map<std::size_t, std::vector<std::size_t>> stays_of_loops;
    for (std::size_t k = 0; k < stays.size(); ++k)
        stays_of_loops[readings[stays[k].readings.front()].loop].push_back(k);
    for (const auto& [loop, numbers] : stays_of_loops) {
        // A step with one stay before or after it is the same as this stay being off.
        if (numbers.size() < 4) continue;
        // A step of the bias has two signs in two faces, and their mean is free of it.
        const int face = readings[stays[numbers.front()].readings.front()].face;
        if (std::ranges::any_of(
                readings, [face](const SearchedReading& reading) { return reading.face != face; }))
            continue;
        const std::size_t first = stays[numbers[2]].readings.front(),
                          last = stays[numbers[numbers.size() - 2]].readings.front();
        for (std::size_t i = first; i <= last; ++i) {
            if (!readings[i].is_accepted || readings[i].loop != loop) continue;
            std::vector<std::size_t> after;
            for (std::size_t k = i; k < readings.size(); ++k)
                if (readings[k].loop == loop) after.push_back(k);
            add(Kind::step, std::move(after));
        }
    }
    return list;
}

/// Returns true for a swap of a stay that is known to be off: the other stay alone is then no sign.
bool is_half_known(const Mistake& mistake, const std::vector<Mistake>& known) {
    if (mistake.kind != Kind::swap) return false;
    return std::ranges::any_of(known, [&](const Mistake& one) {
        if (one.kind == Kind::step) return false;
        const auto is_known = [&](std::size_t i) {
            return std::ranges::count(one.readings, i) + std::ranges::count(one.others, i) > 0;
        };
        return std::ranges::any_of(mistake.readings, is_known) ||
               std::ranges::any_of(mistake.others, is_known);
    });
}

/// Returns the square of the length of an effect, or of the difference of two.
double square_of(const Mistake& mistake, const auto& product) {
    const double square = product(mistake.readings, mistake.readings);
    if (mistake.others.empty()) return square;
    return square + product(mistake.others, mistake.others) -
           2.0 * product(mistake.readings, mistake.others);
}

/// Returns the square of the length; 0 if the unknown quantities explain the effect, but for a part
/// that says nothing.
double information_of(const adjustment::Residuals& residuals, const Mistake& mistake) {
    // Below this share the uncertainty of the size is 1000 times that of the readings.
    constexpr double kLeastShare = 1e-6;
    const double square = square_of(
        mistake, [&](const auto& a, const auto& b) { return residuals.information(a, b); });
    double whole = residuals.whole(mistake.readings);
    if (!mistake.others.empty()) whole += residuals.whole(mistake.others);
    return square > kLeastShare * whole ? square : 0.0;
}

double scattered_of(const adjustment::Residuals& residuals, const Mistake& mistake) {
    return square_of(mistake,
                     [&](const auto& a, const auto& b) { return residuals.scattered(a, b); });
}

/// Finds those of which the residuals contain something.
std::vector<Suspect> suspects_of(const adjustment::Residuals& residuals,
                                 const std::vector<SearchedReading>& readings,
                                 const std::vector<Mistake>& known, Sums& sums) {
    std::vector<Suspect> suspects;
    for (Mistake& mistake : possible_mistakes(readings)) {
        if (is_half_known(mistake, known) ||
            std::ranges::any_of(known, [&](const Mistake& one) { return one.is_same(mistake); }))
            continue;
        const double square = information_of(residuals, mistake);
        if (square == 0.0) continue;
        Suspect suspect;
        const double size = std::abs(mistake.size_mgal);
        suspect.length = std::sqrt(square) * (mistake.others.empty() ? 1.0 : size);
        if (!(suspect.length > 0.0)) continue;
        suspect.factor = mistake.others.empty() ? 1.0 / suspect.length : mistake.size_mgal;
        suspect.scatter_square = suspect.factor * suspect.factor *
                                 (residuals.is_plain() ? square : scattered_of(residuals, mistake));
        suspect.mistake = std::move(mistake);
        suspects.push_back(std::move(suspect));
    }
    // The steps of a loop are nested: each sum continues that of the next step.
    std::map<std::size_t, const Suspect*> next_step;
    for (auto suspect = suspects.rbegin(); suspect != suspects.rend(); ++suspect) {
        const adjustment::Effect& effect = suspect->mistake.readings;
        if (suspect->mistake.kind != Kind::step) {
            suspect->sum = sums.of(effect);
            if (suspect->is_swap()) suspect->other_sum = sums.of(suspect->mistake.others);
            continue;
        }
        const Suspect*& next = next_step[readings[effect.front()].loop];
        const auto end = next == nullptr
                             ? effect.end()
                             : std::ranges::find(effect, next->mistake.readings.front());
        suspect->sum =
            next == nullptr ? sums.of(effect) : sums.more({effect.begin(), end}, next->sum);
        next = &*suspect;
    }
    return suspects;
}

/// Returns the range of the size of a mistake, mGal.
double size_range_mgal(const std::vector<Suspect>& suspects) {
    std::vector<double> lengths;
    for (const Suspect& suspect : suspects)
        if (!suspect.is_swap()) lengths.push_back(suspect.length);
    if (lengths.empty()) return kSizeRange_mgal;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    return std::min(kSizeRange_mgal, kLargestSize_u / *middle);
}

/// Sets the penalty of each suspect: ln(number of its class), plus that of an unknown size within
/// size_range_mgal().  Classes are readings and stations, swaps, steps.
void set_costs(std::vector<Suspect>& suspects) {
    const auto class_of = [](const Suspect& suspect) {
        const Kind kind = suspect.mistake.kind;
        return kind == Kind::swap || kind == Kind::step ? kind : Kind::station;
    };
    std::map<Kind, double> counts;
    for (const Suspect& suspect : suspects) ++counts[class_of(suspect)];
    const double range_mgal = size_range_mgal(suspects);
    for (Suspect& suspect : suspects) {
        suspect.cost = std::log(counts[class_of(suspect)]);
        if (!suspect.is_swap())
            suspect.cost +=
                std::log(range_mgal * suspect.length / std::sqrt(2.0 * std::numbers::pi));
    }
}

}  // namespace

std::size_t Sums::of(const adjustment::Effect& readings) {
    const auto [at, is_new] = numbers_.emplace(readings, groups_.size());
    if (is_new) groups_.push_back({readings, std::nullopt});
    return at->second;
}

std::size_t Sums::more(const adjustment::Effect& readings, std::size_t other) {
    groups_.push_back({readings, other});
    return groups_.size() - 1;
}

std::vector<double> Sums::over(const Eigen::VectorXd& values) const {
    std::vector<double> sums;
    sums.reserve(groups_.size());
    for (const Group& group : groups_) {
        double sum = group.other ? sums[*group.other] : 0.0;
        for (const std::size_t i : group.readings) sum += values(static_cast<Index>(i));
        sums.push_back(sum);
    }
    return sums;
}

/// Sums of a survey's readings, real or simulated.
struct Trial::Products {
    std::vector<double> weighted, scatter;  ///< `scatter` is empty if it is equal to `weighted`.
    double square = 0.0;

    [[nodiscard]] static double of(const Suspect& suspect, const std::vector<double>& sums) {
        return suspect.factor * (suspect.is_swap() ? sums[suspect.sum] - sums[suspect.other_sum]
                                                   : sums[suspect.sum]);
    }

    /// Returns the share of the scatter that a mistake explains, 0 to 1.
    [[nodiscard]] double share_of(const Suspect& suspect) const {
        const double t = of(suspect, weighted);
        const double part = suspect.is_swap() ? 1.0 : t;
        const double length = suspect.is_swap() ? suspect.length : 1.0;
        const double gain = part * (2.0 * t - part * length * length);
        if (!(gain > 0.0)) return 0.0;
        const double rest = square -
                            2.0 * part * of(suspect, scatter.empty() ? weighted : scatter) +
                            part * part * suspect.scatter_square;
        return gain / (gain + rest);
    }
};

Trial::Trial(std::shared_ptr<const adjustment::Residuals> residuals,
             const std::vector<SearchedReading>& readings, const std::vector<Mistake>& known)
    : residuals_(std::move(residuals)),
      dof_(residuals_->dof()),
      suspects_(suspects_of(*residuals_, readings, known, sums_)) {
    set_costs(suspects_);
}

bool Trial::is_possible() const { return !suspects_.empty() && dof_ >= kFewestDof; }

bool Trial::allows_trial() const { return dof_ >= kFewestTrialDof; }

double Trial::gain_of(const Trial& other, std::span<const Mistake> mistakes) const {
    double cost = 0.0;
    for (const Mistake& mistake : mistakes)
        for (const Suspect& suspect : suspects_)
            if (suspect.mistake.is_same(mistake)) cost += suspect.cost;
    return 0.5 * dof_ * std::log(residuals_->seen().square / other.residuals_->seen().square) -
           cost;
}

std::vector<Scored> Trial::best(std::size_t count) const {
    const Products products = products_of(residuals_->seen());
    std::vector<std::pair<double, const Suspect*>> scores;
    for (const Suspect& suspect : suspects_)
        scores.emplace_back(score_of(suspect, products), &suspect);
    std::ranges::stable_sort(scores, std::ranges::greater(),
                             &std::pair<double, const Suspect*>::first);
    std::vector<Scored> best;
    for (const auto& [score, suspect] : scores)
        if (best.size() < count) best.push_back({measured(*suspect), score});
    return best;
}

void Trial::measure(Mistake& mistake, double level) const {
    const auto found = std::ranges::find_if(
        suspects_, [&](const Suspect& suspect) { return suspect.mistake.is_same(mistake); });
    if (found == suspects_.end() || dof_ < kFewestDof) {
        mistake.p = 1.0;
        return;
    }
    mistake = measured(*found);
    mistake.p = probability(score_of(*found, products_of(residuals_->seen())), level);
}

Mistake Trial::measured(const Suspect& suspect) const {
    Mistake mistake = suspect.mistake;
    if (suspect.is_swap()) return mistake;
    // d'q / d'Md and 1 / sqrt(d'Md)
    double sum = 0.0;
    for (const std::size_t i : mistake.readings)
        sum += residuals_->seen().weighted(static_cast<Index>(i));
    mistake.size_mgal = sum / (suspect.length * suspect.length);
    mistake.u_mgal = 1.0 / suspect.length;
    return mistake;
}

Trial::Products Trial::products_of(const adjustment::Seen& seen) const {
    Products products{sums_.over(seen.weighted), {}, seen.square};
    if (!residuals_->is_plain()) products.scatter = sums_.over(seen.scatter);
    return products;
}

double Trial::score_of(const Suspect& suspect, const Products& products) const {
    return -0.5 * dof_ * std::log1p(-products.share_of(suspect)) - suspect.cost;
}

/// Returns the highest score of all suspects.
double Trial::best_score(const adjustment::Seen& seen) const {
    const Products products = products_of(seen);
    double best = -HUGE_VAL;
    for (const Suspect& suspect : suspects_) best = std::max(best, score_of(suspect, products));
    return best;
}

/// Returns an upper limit of the probability that anything has such a score, if there is no mistake:
/// the sum over all suspects.  The share of one direction in a plain scatter has a beta distribution,
/// so that (dof - 1) share / (1 - share) is the square of a Student's t.
double Trial::largest_probability(double score) const {
    double sum = 0.0;
    for (const Suspect& suspect : suspects_) {
        const double share = -std::expm1(-2.0 * (score + suspect.cost) / dof_);
        if (!(share > 0.0)) return 1.0;
        if (!(share < 1.0)) continue;
        const double t = std::sqrt((dof_ - 1.0) * share / (1.0 - share));
        sum += 2.0 * signal::students_t_exceedance(dof_ - 1.0, t);
    }
    return std::min(1.0, sum);
}

/// Returns the probability that anything has such a score, if there is no mistake: an upper limit where
/// that is below the level, and a rough value where it is clearly above.
double Trial::probability(double score, double level) const {
    if (residuals_->is_plain())
        if (const double most = largest_probability(score); most <= level) return most;
    std::mt19937_64 generator(1);  // fixed seed: the same day gives the same probability
    int higher = 0, draws = 0;
    while (draws < kMostDraws) {
        for (int k = 0; k < kDrawsEach; ++k, ++draws)
            if (best_score(residuals_->simulated(generator)) >= score) ++higher;
        // Four standard deviations of a count above its expectation at the level, or below that of
        // the level of a headline.
        const double expected = level * draws, of_headline = std::min(level, kHeadlineP) * draws;
        if (higher > expected + 4.0 * std::sqrt(expected) + 4.0 ||
            higher + 4.0 * std::sqrt(static_cast<double>(higher)) + 4.0 < of_headline)
            break;
    }
    return (1.0 + higher) / (1.0 + draws);
}

}  // namespace a351::corrector::judgement
