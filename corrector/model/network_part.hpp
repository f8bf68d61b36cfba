#pragma once
/// @file
/// Rows and global test of an adjusted network.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace a351::corrector::model {

/// Probability of v^T W v above the upper limit of the global test, or below the lower one, although
/// all standard deviations are right.  Reason: the usual 5 % on both sides together.
inline constexpr double kGlobalTestAlpha = 0.025;

/// Least redundancy of a controlled row.  Below it, less than a tenth of a blunder shows in the
/// row's own residual.
inline constexpr double kControlledRedundancy = 0.1;

/// A row of a network: a reading, a datum or a prior, in mGal or in the unit of the coefficient.
struct NetworkRow {
    /// Name of the row: `S2 (1)` for a reading (site and stay), `datum S2`, `prior` and the coefficient.
    std::string label;
    double residual = 0.0;    ///< y - A x.
    double sd = 1.0;          ///< Standard deviation a priori.
    double redundancy = 0.0;  ///< 0: uncontrolled, 1: fully controlled.
};

/// Values that only `network` gives.
struct NetworkPart {
    std::vector<NetworkRow> rows;         ///< Readings in use in order of time; datum; priors.
    std::size_t reading_count = 0;        ///< Number of readings in use.
    std::vector<std::string> held_sites;  ///< Stations whose reference is held.
    std::size_t unknown_count = 0, station_count = 0;  ///< Unknowns, and gravities among them.
    std::size_t dof = 0;                               ///< Degrees of freedom: rows - unknowns.
    double weighted_square = 0.0;                      ///< v^T W v
    double chi_square_low = 0.0,
           chi_square_high = 0.0;  ///< Limits of the global test; 0 if dof = 0.

    /// Returns true if the reference of a station is held.
    [[nodiscard]] bool holds(const std::string& site) const {
        return std::ranges::find(held_sites, site) != held_sites.end();
    }

    /// Returns s0 = sqrt(v^T W v / dof), the ratio of the standard deviations a posteriori and a
    /// priori; absent if dof = 0.
    ///
    /// About 1: the standard deviations agree with the residuals.  Far above 1: they are too small,
    /// or there is a blunder.  Far below 1: they are too large.
    [[nodiscard]] std::optional<double> s0() const {
        if (dof == 0) return std::nullopt;
        return std::sqrt(weighted_square / static_cast<double>(dof));
    }
    /// Returns true if v^T W v is at most the upper limit; absent if dof = 0.
    [[nodiscard]] std::optional<bool> passes_global_test() const {
        if (dof == 0) return std::nullopt;
        return weighted_square <= chi_square_high;
    }
    /// Returns true if v^T W v is above the upper limit: readings scatter more than stated.
    [[nodiscard]] bool scatters_more_than_stated() const {
        return !passes_global_test().value_or(true);
    }
    /// Returns true if v^T W v is below the lower limit: readings scatter less than stated.
    [[nodiscard]] bool scatters_less_than_stated() const {
        return dof > 0 && weighted_square < chi_square_low;
    }
};

}  // namespace a351::corrector::model
