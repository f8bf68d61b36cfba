#pragma once
/// @file
/// The mistakes that there may be in a survey, compared with its residuals.
///
/// It is a part of search_mistakes().  The known mistakes are put right in the residuals:
///
///     const Trial trial(residuals, readings, known);
///     if (trial.is_possible()) {
///         Mistake mistake = trial.best(1).front().mistake;
///         trial.measure(mistake, kMistakeAlpha);   // its size and probability
///     }

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "corrector/adjustment/residuals.hpp"
#include "corrector/judgement/mistake_search.hpp"

namespace a351::corrector::judgement {

/// A mistake and how well it explains the residuals.
struct Scored {
    Mistake mistake;
    double score = 0.0;
};

/// A mistake to be tested.
///
/// Its product with the residuals is `factor` times the sum over its readings, minus that over the
/// others.  A step adds to the sum of the next step of its loop.
struct Suspect {
    Mistake mistake;
    double factor = 1.0;  ///< 1 / length of the effect of 1 mGal; of a swap its size.
    double length = 0.0;  ///< Length of the effect of 1 mGal; of a swap that of the whole effect.
    double scatter_square = 0.0;  ///< Square of the length of the effect's part in the scatter.
    double cost = 0.0;            ///< Subtracted from the score: number of its class, unknown size.
    std::size_t sum = 0, other_sum = 0;  ///< Numbers of Sums of its readings.

    [[nodiscard]] bool is_swap() const { return mistake.kind == adjustment::AlternativeKind::swap; }
};

/// Sums over groups of readings, each computed once for all suspects.
class Sums {
public:
    /// Returns the number of the sum over some readings.
    std::size_t of(const adjustment::Effect& readings);
    /// Returns the number of the sum over some readings and those of another sum.
    std::size_t more(const adjustment::Effect& readings, std::size_t other);
    /// Returns all sums of the values.
    [[nodiscard]] std::vector<double> over(const Eigen::VectorXd& values) const;

private:
    struct Group {
        adjustment::Effect readings;
        std::optional<std::size_t> other;
    };
    std::vector<Group> groups_;
    std::map<adjustment::Effect, std::size_t> numbers_;
};

/// The residuals of a survey with everything that may explain them.
class Trial {
public:
    /// @param known  mistakes that are put right in the residuals.
    Trial(std::shared_ptr<const adjustment::Residuals> residuals,
          const std::vector<SearchedReading>& readings, const std::vector<Mistake>& known);

    /// Returns false if too few readings are left to explain anything.
    [[nodiscard]] bool is_possible() const;
    /// Returns true if enough readings are left to put a mistake right on trial.
    [[nodiscard]] bool allows_trial() const;

    /// Returns how much less is left with further mistakes put right: dof / 2 ln(square / square of
    /// the other trial), less Suspect::cost of each.
    [[nodiscard]] double gain_of(const Trial& other, std::span<const Mistake> mistakes) const;

    /// Returns the mistakes with the highest score, the best first, with their sizes.  The score is
    /// -dof / 2 ln(1 - share) less Suspect::cost.
    [[nodiscard]] std::vector<Scored> best(std::size_t count) const;

    /// Sets the size of a mistake and its probability; 1 if the residuals contain nothing of it.
    /// @param level  probability with which it is compared; one that is far above is only rough.
    void measure(Mistake& mistake, double level) const;

private:
    struct Products;

    [[nodiscard]] Mistake measured(const Suspect& suspect) const;
    [[nodiscard]] Products products_of(const adjustment::Seen& seen) const;
    [[nodiscard]] double score_of(const Suspect& suspect, const Products& products) const;
    [[nodiscard]] double best_score(const adjustment::Seen& seen) const;
    [[nodiscard]] double probability(double score, double level) const;
    [[nodiscard]] double largest_probability(double score) const;

    std::shared_ptr<const adjustment::Residuals> residuals_;
    double dof_ = 0.0;  ///< Degrees of freedom of the scatter.
    Sums sums_;
    std::vector<Suspect> suspects_;
};

}  // namespace a351::corrector::judgement
