#pragma once
/// @file
/// Unknown stations, known ones and the instrument in one least-squares adjustment of readings:
///
///     reading_i = g(station_i) + constant + drift (t_i - t0)^k + bT (T_i - T0) + bR R_i + error_i
///     datum:      g(k) = reference_k +- datum_sd           one row for each station held
///     prior:      coefficient = mean +- sd                 one row each
///
///     x = (A^T W A)^-1 A^T W y,  v = A x - y,  s0^2 = v^T W v / dof,  r_i = (Q_vv W)_ii
///
/// A pause of more than kLoopPause_h begins a loop with a constant and a drift of its own; one that
/// has no reading in use has neither.  The rate takes part when it has a prior.  Which unknowns are open and why: network_diagnosis.hpp.
/// Redundancy numbers: W. Baarda, A testing procedure for use in geodetic networks, Delft 1968.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "corrector/model/prior.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

/// No day of survey pauses so long; the instrument switched off and on again has a new constant.
inline constexpr double kLoopPause_h = 6.0;

/// Of the two-sided global test.
inline constexpr double kGlobalTestAlpha = 0.05;

/// A row whose redundancy is less is practically uncontrolled . less than a tenth of a blunder
/// would show in its own residual.
inline constexpr double kControlledRedundancy = 0.1;

struct NetworkOptions {
    /// Of a reference: a hundredth of what this sensor can do, as gravity networks are known.
    double datum_sd_mgal = 0.01;
    int drift_degree = 1;  ///< 0 to 2; column k is (t - t0)^k.
};

/// A row of the system: of a reading, a datum or a prior.
struct NetworkRow {
    std::string label;
    double residual = 0.0;    ///< v, in the unit of the row.
    double sd = 1.0;          ///< A priori.
    double redundancy = 0.0;  ///< 0: uncontrolled, 1: fully controlled.
};

struct NetworkAdjustment {
    std::vector<std::string> stations;
    std::vector<std::string> terms;  ///< Of the instrument, with units.
    MilliGal origin;                 ///< Added to the unknowns of the stations.
    Eigen::VectorXd unknowns;        ///< Stations, then terms.
    Eigen::MatrixXd covariance;      ///< A priori.
    Eigen::MatrixXd term_columns;    ///< One line per survey row, in use or not.
    std::vector<bool> is_tied;       ///< One per survey row: its loop has a reading in use.
    std::vector<NetworkRow> rows;    ///< Readings in use, in order; datum; priors.
    std::size_t reading_count = 0;
    std::size_t datum_count = 0;
    std::size_t dof = 0;
    double weighted_square = 0.0;  ///< v^T W v
    double chi_square_low = 0.0;   ///< Limits of the global test; both 0 without dof.
    double chi_square_high = 0.0;
    std::vector<std::string> remarks;  ///< What the user has to know of it.

    /// a posteriori / a priori standard deviation; absent without dof.
    [[nodiscard]] std::optional<double> s0() const;
    /// Absent without dof.
    [[nodiscard]] std::optional<bool> passes_global_test() const;
    /// Residual of a reading / its standard deviation with the scale from the other rows; positive
    /// where the reading is too low.  Absent for an uncontrolled one, and with dof < 2.
    [[nodiscard]] std::optional<double> studentised(std::size_t reading) const;
    /// What a term adds to gravity in a survey row.
    [[nodiscard]] double effect_mgal(std::size_t row, std::size_t term) const;
};

/// The adjustment, or in words why there is none.
struct NetworkResult {
    std::optional<NetworkAdjustment> adjustment;
    std::string refusal;  ///< `trouble; allowed: ...`, empty when `adjustment` is there.
};

/// @param rows    in ascending time.
/// @param in_use  one per row; a reference is not needed.
/// @param datum   stations to hold; empty: all that have a reference.
[[nodiscard]] NetworkResult adjust_network(const std::vector<SurveyRow>& rows,
                                           const std::vector<bool>& in_use,
                                           const std::vector<std::string>& datum,
                                           const ModelPriors& priors,
                                           const NetworkOptions& options);

}  // namespace a351::corrector
