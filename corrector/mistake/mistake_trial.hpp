#pragma once
/// @file
/// The mistakes that there may be in a survey, compared with its residuals.
///
/// It is a part of search_mistakes().  The known mistakes are put right in the residuals:
///
///     const Trial trial(residuals, readings, known);
///     if (trial.is_possible()) {
///         Mistake mistake = trial.best(1).front().mistake;
///         trial.measure(mistake);                  // its size and probability
///     }

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "corrector/mistake/mistake_search.hpp"
#include "corrector/residual/residuals.hpp"

namespace a351::corrector::mistake {

/// A mistake and how well it explains the residuals.
struct Scored {
    Mistake mistake;
    double score = 0.0;
};

/// A mistake to be tested.
///
/// Its effect on the residuals is a direction.  That of a swap is `size` times the difference of the
/// effects of both stays, so that thousands of pairs need no vectors of their own.
struct Suspect {
    Mistake mistake;
    Eigen::Index direction = 0, other = -1;  ///< Columns of Directions; -1: there is none.
    double size = 1.0;
    double length = 0.0;  ///< Length of the effect of 1 mGal; of a swap that of the whole effect.
    double scatter_square = 0.0;  ///< Square of the length of the effect's part in the scatter.
    double cost = 0.0;            ///< Subtracted from the score: number of its class, unknown size.

    [[nodiscard]] bool has_size() const { return other >= 0; }
    /// Returns the product of the effect with something, from its products with the directions.
    [[nodiscard]] double product(const Eigen::VectorXd& with) const {
        return other < 0 ? with(direction) : size * (with(direction) - with(other));
    }
};

/// Directions of the residuals (k, m), and their parts in the scatter.
struct Directions {
    Eigen::MatrixXd effects, scatters;
};

/// Products of a survey's residuals, real or simulated, with the directions.
struct Seen {
    Eigen::VectorXd values, scatters;  ///< (m)
    double square = 0.0;               ///< Square of the length of the whole scatter.
};

/// The residuals of a survey with everything that may explain them.
class Trial {
public:
    /// @param known  mistakes that are put right in the residuals.
    Trial(residual::Residuals residuals, const std::vector<SearchedReading>& readings,
          const std::vector<Mistake>& known);

    /// Returns false if too few readings are left to explain anything.
    [[nodiscard]] bool is_possible() const;
    /// Returns true if enough readings are left to put a mistake right on trial.
    [[nodiscard]] bool allows_trial() const;

    /// Returns the mistakes with the highest score, the best first, with their sizes.  The score is
    /// -dof / 2 ln(1 - share) less Suspect::cost.
    [[nodiscard]] std::vector<Scored> best(std::size_t count) const;

    /// Sets the size of a mistake and its probability; 1 if the residuals contain nothing of it.
    void measure(Mistake& mistake) const;

private:
    [[nodiscard]] Mistake measured(const Suspect& suspect) const;
    [[nodiscard]] Seen seen_in(const Eigen::VectorXd& values) const;
    [[nodiscard]] double score_of(const Suspect& suspect, const Seen& seen) const;
    [[nodiscard]] double best_score(const Eigen::VectorXd& values) const;
    [[nodiscard]] double probability(double score) const;

    residual::Residuals residuals_;
    Directions directions_;
    double dof_ = 0.0;  ///< Degrees of freedom of the scatter.
    std::vector<Suspect> suspects_;
};

}  // namespace a351::corrector::mistake
