#pragma once
/// @file
/// What the residuals of a survey say about an effect on some of its readings, without another fit.
///
/// Let y be the readings, S the covariance of their errors and of what priors leave open, and B the
/// effects of the unknown quantities.  Everything that can be said about an effect d follows from
///
///     M = S^-1 - S^-1 B (B' S^-1 B)^-1 B' S^-1,      q = M y
///     size of the effect  d'q / d'Md,   its standard uncertainty  1 / sqrt(d'Md)
///
/// (an alternative hypothesis in the sense of W. Baarda, A testing procedure for use in geodetic
/// networks, Delft 1968).  The *scatter* of the readings is q'Gq.  G is the covariance of the noise
/// alone, so that priors may be too wide, or S.

#include <Eigen/Core>
#include <random>
#include <vector>

namespace a351::corrector::adjustment {

/// Numbers of readings, each with an effect of +1 mGal.
using Effect = std::vector<std::size_t>;

/// Readings of a survey as the residuals see them.
struct Seen {
    Eigen::VectorXd weighted;  ///< (n) q, 1/mGal.
    Eigen::VectorXd scatter;   ///< (n) M G q; empty: equal to `weighted`.
    double square = 0.0;       ///< q'Gq.
};

/// Residuals of n readings.  Members may be called from several threads at a time.
class Residuals {
public:
    Residuals() = default;
    Residuals(const Residuals&) = delete;
    Residuals& operator=(const Residuals&) = delete;
    virtual ~Residuals() = default;

    /// Returns the readings themselves.
    [[nodiscard]] virtual const Seen& seen() const = 0;
    /// Returns the expected square of the scatter: its degrees of freedom.
    [[nodiscard]] virtual double dof() const = 0;
    /// Returns readings as they would be if the model were true.
    [[nodiscard]] virtual Seen simulated(std::mt19937_64& generator) const = 0;
    /// Returns a'Mb, 1/mGal^2.
    [[nodiscard]] virtual double information(const Effect& a, const Effect& b) const = 0;
    /// Returns d'S^-1 d of readings whose station and instrument were known, 1/mGal^2.
    [[nodiscard]] virtual double whole(const Effect& d) const = 0;
    /// Returns a'MGMb.
    [[nodiscard]] virtual double scattered(const Effect& a, const Effect& b) const = 0;
    /// Returns true if G = S: the scatter is that of all errors, and follows from M alone.
    [[nodiscard]] virtual bool is_plain() const = 0;
};

}  // namespace a351::corrector::adjustment
