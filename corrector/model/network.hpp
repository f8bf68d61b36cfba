#pragma once
/// @file
/// One least-squares adjustment of all readings for unknown stations, known stations and
/// instrument:
///
///     reading_i = g0 + S (g(station_i) - g0) + constant + drift (t_i - t0)^k + bT (T_i - T0) + bR R_i
///                 [+ bP (p_i - p_n)] + error_i
///     datum:      g(k) = reference_k +- u_k or datum_sd    one row for each station held
///     prior:      coefficient = mean +- sd                 one row for each prior
///
///     x = (A^T W A)^-1 A^T W y,  v = A x - y,  s0^2 = v^T W v / dof,  r_i = (Q_vv W)_ii
///
/// reading_i is acceleration - tide, mGal; W is the diagonal matrix of 1 / sd^2.
/// Each instrument has loops of its own, with their own constant and drift.  A new loop begins after a
/// pause of more than kLoopPause_h, and where the table has another loop.  A loop without a reading in
/// use has neither constant nor drift.  The rate R takes part only if it has a prior.
///
/// S is the scale of the instrument, one for each, always with a prior (Priors::scale_of()); g0 is the
/// reference of the first station held.  S times an unknown gravity is not linear.  About approximate
/// values g1 and S1, which are those of the round before, the system is
///
///     reading_i - g0 + (g1 - g0) (S1 - 1) = S1 (g - g0) + (g1 - g0) (S - 1) + ...
///
/// kScaleRounds rounds leave less than 1e-9 mGal (network_test.cpp).
///
/// T0 is kReferenceTemperature; t0 is kReferenceTime_h after the first row of the loop; k is 0 to
/// drift_degree.  Pauses are those between rows of an instrument, in use or not.
///
/// Use it to find many unknown stations from repeated readings and a few known ones.  A station
/// read once gets a value, but no error of its reading can be found.
///
///     const NetworkResult result = adjust_network(rows, in_use, {"No.0"}, priors, options);
///     if (!result.adjustment) return result.refusal.trouble;
///     const NetworkAdjustment& network = *result.adjustment;
///     network.origin + MilliGal(network.unknowns(0));  // gravity of network.stations[0]
///     std::sqrt(network.covariance(0, 0));             // its uncertainty a priori, mGal
///
/// All functions are pure and deterministic.
///
/// Methods: corrector/methods.md, "Networks".
/// Redundancy numbers: W. Baarda, A testing procedure for use in geodetic networks, Delft 1968.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/model_fit.hpp"
#include "corrector/model/prior.hpp"
#include "corrector/model/refusal.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Pause between two readings that begins a new loop, h.  Reason: no survey day has so long a
/// pause; after it the instrument was switched off and on again and has a new constant.
inline constexpr double kLoopPause_h = 6.0;

/// Probability of v^T W v above the upper limit of the global test, or below the lower one, although
/// all standard deviations are right.  Reason: the usual 5 % on both sides together.
inline constexpr double kGlobalTestAlpha = 0.025;

/// Least redundancy of a controlled row.  Below it, less than a tenth of a blunder shows in the
/// row's own residual.
inline constexpr double kControlledRedundancy = 0.1;

/// Least redundancy of a row that v / r predicts without itself.  Reason: below it v / r is rounding.
inline constexpr double kLeastRedundancy = 1e-9;

/// Greatest degree of the drift of a loop.  Reason: spring gravimeters are adjusted with a cubic
/// drift at most; a higher degree follows the readings.
inline constexpr int kGreatestDriftDegree = 3;

/// Number of adjustments, each linearised about the one before.  The first has no approximate gravity.
/// Reason: the error of a round is that of the one before squared, times 1e-2 at most.
inline constexpr int kScaleRounds = 5;

/// Returns the number of the loop of each row, from 0 in order of their first row.
[[nodiscard]] std::vector<std::size_t> loop_numbers(const std::vector<reading::SurveyRow>& rows);

/// Effect that a term of the instrument describes.
enum class TermKind { constant, drift, temperature, rate, admittance, step, scale };

/// A term of the instrument.
struct NetworkTerm {
    TermKind kind = TermKind::constant;
    /// Name with unit; from the second loop on with a suffix `_loop2`, and the scales from the second
    /// instrument on with `_instrument2`.
    std::string name;
    /// Prior of its unknown; the drifts of all loops have the same.  Absent for a scale, whose prior is
    /// in NetworkScale.
    std::optional<Prior> prior;
};

/// Scale of an instrument in an adjustment.
struct NetworkScale {
    std::string instrument;  ///< Name of the gravimeter; empty for the sensor.
    Prior prior;
    std::size_t term = 0;     ///< Number of its term, whose unknown is S - 1.
    double linearised = 1.0;  ///< S1 of the last round.
};

/// Options of the adjustment.
struct NetworkOptions {
    /// Standard deviation of a reference that has none of its own, mGal.  Default: typical of gravity
    /// networks, and a hundredth of what this sensor can achieve.  It must be above 0; this is not checked.
    double datum_sd_mgal = 0.01;
    /// True: the admittance of the air pressure is an unknown; the readings are not reduced for it.
    bool fits_admittance = false;
    int drift_degree = 1;  ///< 0 to kGreatestDriftDegree; column k is (t - t0)^k, t in h.
    std::vector<Step> steps;  ///< Offsets of the readings of the same loop, in order of time.
};

/// A row of the system: a reading, a datum or a prior.
///
/// The unit of a reading or a datum is mGal, that of a prior is the unit of its coefficient.
struct NetworkRow {
    /// Name of the row in messages and tables: `S2 (1)` for a reading (site and stay), `datum S2`,
    /// or `prior` and the name of the term.
    std::string label;
    double residual = 0.0;    ///< v = A x - y, in the unit of the row.
    double sd = 1.0;          ///< Standard deviation a priori, in the unit of the row.
    double redundancy = 0.0;  ///< 0: uncontrolled, 1: fully controlled.
    /// Number of the station that a datum holds; absent for a reading or a prior.
    std::optional<std::size_t> held = {};
};

/// An adjusted network: s stations, m terms of the instrument, n survey rows.
struct NetworkAdjustment {
    std::vector<std::string> stations;  ///< (s) Names, in order of the first reading in use.
    std::vector<NetworkTerm> terms;     ///< (m) Terms of the instrument.
    std::vector<NetworkScale>
        scales;                ///< One per instrument, in order of its first row in a loop in use.
    MilliGal origin;           ///< Gravity of a station = origin + its unknown.
    Eigen::VectorXd unknowns;  ///< (s + m) Stations (mGal), then terms.
    Eigen::MatrixXd covariance;  ///< (s + m, s + m) Covariance of the unknowns a priori.
    /// (n, m) Regressors of the terms, rows in use or not; 0 in rows that are not tied.
    Eigen::MatrixXd term_columns;
    std::vector<bool> is_tied;      ///< (n) True if the loop of the row has a reading in use.
    std::vector<NetworkRow> rows;   ///< Readings in use in order of time; datum; priors.
    std::size_t reading_count = 0;  ///< Number of readings in use.
    std::size_t datum_count = 0;    ///< Number of stations held.
    bool is_level_known = true;     ///< False: the gravity that is held is not a published one.
    std::size_t dof = 0;            ///< Degrees of freedom: rows - unknowns.
    double weighted_square = 0.0;   ///< v^T W v
    double chi_square_low = 0.0;    ///< Lower limit of the global test; 0 if dof = 0.
    double chi_square_high = 0.0;   ///< Upper limit of the global test; 0 if dof = 0.
    std::vector<text::Message> remarks;  ///< Facts that the user must know, in sentences.

    /// Returns s0 = sqrt(v^T W v / dof), the ratio of the standard deviations a posteriori and a
    /// priori; absent if dof = 0.
    ///
    /// About 1: the standard deviations agree with the residuals.  Far above 1: they are too small,
    /// or there is a blunder.  Far below 1: they are too large.
    [[nodiscard]] std::optional<double> s0() const;
    /// Returns true if v^T W v is at most the upper limit; absent if dof = 0.
    [[nodiscard]] std::optional<bool> passes_global_test() const;
    /// Returns true if v^T W v is below the lower limit: readings scatter less than stated.
    [[nodiscard]] bool scatters_less_than_stated() const {
        return dof > 0 && weighted_square < chi_square_low;
    }
    /// Returns the external studentised residual v / (sd s_i sqrt(r)) of a reading, where
    /// s_i^2 = (v^T W v - (v / sd)^2 / r) / (dof - 1) comes from the other rows.  Positive: the
    /// reading is too low.  Absent if r < kLeastRedundancy, if dof < 2, or if s_i is not positive.
    /// @param reading  number of the reading, below reading_count.
    [[nodiscard]] std::optional<double> studentised(std::size_t reading) const;
    /// Returns the contribution of a term to the reading of a survey row, mGal.  To correct the
    /// reading, subtract it.
    /// @param row   number of the survey row, in use or not.
    /// @param term  number in `terms`.
    [[nodiscard]] double effect_mgal(std::size_t row, std::size_t term) const;
    /// Returns the row that holds a station; null if none does.  The pointer is into this object.
    [[nodiscard]] const NetworkRow* datum_of(std::string_view site) const;
};

/// The adjustment, or the reason why there is none.
struct NetworkResult {
    std::optional<NetworkAdjustment> adjustment;  ///< Absent: see `refusal`.
    Refusal refusal;                              ///< Empty if there is an adjustment.
};

/// Adjusts a network.
///
/// The global test compares v^T W v with the chi-square distribution of `dof` degrees of freedom.
/// It fails above the upper limit only (kGlobalTestAlpha); nothing is scaled then.
///
/// A temperature that does not vary between the rows in use, and has no prior, is left out with a
/// remark.  Remarks also name stations that only the drift connects with a datum, and readings with
/// a redundancy below kControlledRedundancy.
///
/// An unknown is undetermined if it takes part in a combination of unknowns that changes no row.
/// The limit is 1e-9 of the largest singular value, with columns of length 1.
///
/// Cost: a singular value decomposition, O(r u^2) for r rows and u unknowns.
///
/// Accuracy (network_test.cpp): made-up readings with a quadratic drift give back gravity within
/// 1e-9 mGal, drift terms within 1e-9 of their unit, and the temperature coefficient within
/// 1e-8 mGal/degC.  The redundancies of all rows add up to dof.
/// @param rows     (n) in ascending time, at least one; finite.
/// @param in_use   (n); a row in use needs no reference.
/// @param datum    names of the stations to hold; empty: all that have a reference.  A name without
///                 a reading in use has no effect.
/// @param priors   priors on the coefficients, and the standard deviation of a reading.
/// @param options  see NetworkOptions.
/// @return a refusal if no reading is in use, if no station is held, if a listed station has no
///         reference, if stations have no connection with a datum, or if the readings do not
///         determine an unknown.
[[nodiscard]] NetworkResult adjust_network(const std::vector<reading::SurveyRow>& rows,
                                           const std::vector<bool>& in_use,
                                           const std::vector<std::string>& datum,
                                           const Priors& priors, const NetworkOptions& options);

}  // namespace a351::corrector::model
