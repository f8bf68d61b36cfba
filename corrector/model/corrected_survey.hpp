#pragma once
/// @file
/// A survey after the fit of one model: values that every model gives, and values of one model
/// only.
///
///     corrected = acceleration - tide + temperature_correction + rate_correction
///                 + drift_correction (+ tilt_correction + flicker_correction + scale_correction,
///                 if present)
///     residual  = corrected - reference
///
/// The tide is the effect on gravity and is subtracted; every correction is added.  If the
/// temperature makes a reading 1 mGal too large, its temperature_correction is -1 mGal.
///
/// Values that only one model gives are in a variant, which as() reads:
///
///     if (const auto* const day = row.as<WholeDayRow>()) day->flicker_correction;
///     if (const auto* const network = fit.as<NetworkPart>()) network->s0();
///
/// An absent value means that it is not defined for this row or model; it never means 0.  All types
/// own their content and have no references to the input.
/// Methods and sources: corrector/methods.md.

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "corrector/adjustment/prior.hpp"
#include "corrector/adjustment/term.hpp"
#include "corrector/model/score.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"
#include "corrector/whole_day/day_fit.hpp"
#include "corrector/whole_day/goodness_of_fit.hpp"
#include "corrector/whole_day/unit_posterior.hpp"
#include "protocol/text/message.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::model {

/// Greatest degree of the drift of a loop.  Reason: spring gravimeters are adjusted with a cubic
/// drift at most; a higher degree follows the readings.
inline constexpr int kGreatestDriftDegree = 3;

/// Options of a network.
struct NetworkOptions {
    /// Standard deviation of a reference that has none of its own, mGal.  Default: typical of gravity
    /// networks, and a hundredth of the error of this sensor.  It must be above 0 (not checked).
    double datum_sd_mgal = 0.01;
    /// True: the admittance of the air pressure is an unknown; the readings are not reduced for it.
    bool fits_admittance = false;
    int drift_degree = 1;  ///< 0 to kGreatestDriftDegree; powers of t - t0.
};

/// Options of a correction.
///
/// correct_survey() checks `model`, `base` and `datum`.  The other members are not checked.
struct SurveyOptions {
    std::string model = "auto";  ///< One of model_names().
    std::string base;            ///< Station of the drift step; empty: that of the first row.
    /// Stations whose reference is held; empty: all that have one.
    std::vector<std::string> datum;
    std::vector<adjustment::Step> steps;  ///< In order of time; `paper` ignores them.
    /// True: flagged rows are not in the fit.  Excluded rows never are.
    bool use_flags = true;
    NetworkOptions network;  ///< Options of `network`.
    std::uint64_t seed = 1;  ///< Seed of the bootstrap over stations.
    /// Priors of the linear models and the network; `paper` uses none, and `day` refuses them.
    adjustment::Priors priors;
    /// Calibration of the unit.  correct_survey() uses it only as prior of `day`; for other models
    /// call correct_with_calibration().
    std::optional<unit::Calibration> calibration;
};

/// Values of a row that only `paper` gives: in every row.
struct PaperRow {
    MilliGal corrected1;  ///< Corrected (1), before the drift step.
    std::optional<MilliGal>
        residual1;  ///< corrected1 - reference; the publication's Error (1) is its negative.
};

/// Values of a row that only `day` gives: in every row.
struct WholeDayRow {
    double averaged_s = 0.0;            ///< Sum of the durations of the undisturbed samples.
    double fast_rate_degc_per_h = 0.0;  ///< Rate of the temperature in the fast term.
    MilliGal flicker_correction;        ///< Minus the estimated flicker of the row.
    /// Value with the reference of the station hidden.  Absent without a reference, and for rows of
    /// a station that alone is held.  For a row outside the fit it is equal to `corrected`.
    std::optional<MilliGal> left_out;
};

/// A row with its corrections.  The constant of the model belongs to the temperature correction.
///
/// The constant contains the bias of the sensor, up to thousands of mGal.  Only differences of the
/// temperature correction between rows show the effect of the temperature.
struct CorrectedRow {
    reading::SurveyRow row;              ///< Reading; for `day` with means over its bins.
    bool is_used = false;                ///< True for a row in the fit.
    std::optional<MilliGal> difference;  ///< acceleration - reference - tide.
    MilliGal temperature_correction;
    MilliGal rate_correction;
    MilliGal drift_correction;  ///< Steps included.
    /// Present in every row or in none: `day`, `t-rate-drift-axes`, or with a calibration.
    std::optional<MilliGal> tilt_correction;
    /// Minus (S - 1) (g - g0), S the scale of the instrument; in a linear model g0 is 980665 mGal.
    /// Present in every row or in none: a model with a term for the scale.
    std::optional<MilliGal> scale_correction;
    MilliGal corrected;                ///< acceleration - tide + all corrections.
    std::optional<MilliGal> residual;  ///< corrected - reference.
    /// Leverage; for a row outside the fit, the variance of its correction / s^2.  Absent for `day`.
    /// It is at most 1 for a row in the fit, and has no limit for another row.
    std::optional<double> leverage;
    /// Uncertainty as if the station were unknown: sqrt(s^2 + variance of the fit).  `network` and
    /// `day`: see network_model() and whole_day_model().  Absent for the other models if dof is 0.
    std::optional<MilliGal> u_corrected;
    /// External studentised residual; absent for `paper`.
    std::optional<double> studentised_residual;
    /// Reasons to doubt the row without use of gravity, from judgement::correct_and_search().  No row is left out because of them.
    std::string doubt_physical;
    /// Values of one model only.
    std::variant<std::monostate, PaperRow, WholeDayRow> own;

    /// Returns the values of one model; null if another model was fitted.  The pointer is into this
    /// object.
    /// @tparam Part  PaperRow or WholeDayRow.
    template <class Part>
    [[nodiscard]] const Part* as() const {
        return std::get_if<Part>(&own);
    }

    /// Subtracts an effect on the reading: adds it, with the sign turned, to a correction.  That of the
    /// air pressure changes the acceleration, if the row is reduced for it.
    void subtract(adjustment::Correction correction, MilliGal effect);

    /// Returns the tilt correction, 0 if there is none.
    [[nodiscard]] MilliGal tilt_correction_or_zero() const {
        return tilt_correction.value_or(MilliGal(0.0));
    }
};

/// Sources of the uncertainty of a station, as only `day` knows them.
struct StationErrors {
    /// Contributions to u, mGal, in the order of whole_day::ErrorSource; the sum of their squares is
    /// u^2.
    std::array<double, whole_day::kErrorSources> parts_mgal{};
};

/// Errors that a station of one day has in common with stations of other days, as only `day` knows
/// them.
struct SharedErrors {
    /// Those of the unit (whole_day::GravityEstimate::shared_mgal).
    std::vector<double> unit_mgal;  ///< Empty: none.
    bool is_calibrated = false;     ///< The unit's errors are those of its calibration.
    /// Those of the uncertain references that are held, by site.
    std::map<std::string, double> references_mgal;
};

/// Factor of a coverage of about 95 % where the standard deviations do not come from the scatter of
/// few values.
inline constexpr double kCoverageFactor = 2.0;

/// Gravity of a station compared with that of the normal Earth.
struct Anomalies {
    MilliGal normal_gravity;  ///< Gravity of GRS80 on the ellipsoid.
    MilliGal free_air;        ///< gravity - normal gravity at the altitude.
    MilliGal bouguer;         ///< free_air - attraction of a plate up to the altitude.
};

/// The value of a station.
///
/// For a station with a reference in the fit, `gravity` is in sample: the fit has seen the
/// reference.  `left_out` has not.
struct StationValue {
    std::string site;              ///< Name of the station.
    std::size_t row_count = 0;     ///< Number of rows averaged; `network`: readings adjusted.
    bool is_flagged_only = false;  ///< True: no row is unflagged; the flagged are averaged.
    MilliGal gravity;              ///< Mean of its corrected values; `network`: adjusted value.
    /// Uncertainty sqrt(s^2 / n + variance of the fit); `network`: a priori; `day`: as if the
    /// reference of the station were unknown.
    std::optional<MilliGal> u_gravity;
    std::optional<MilliGal> u_a_posteriori;  ///< `network` only: s0 times u_gravity.
    std::optional<MilliGal> reference;       ///< Known gravity.
    std::optional<MilliGal> residual;        ///< gravity - reference.
    /// Sum of 1 - leverage over its rows in the fit; `network`: and the redundancy of its datum.
    /// Absent without a row in the fit, and for `day`.
    std::optional<double> redundancy;
    /// Value with the station's own reference hidden, and its standard uncertainty.  A station
    /// without a reference in the fit has gravity and its uncertainty.  Absent for the other stations
    /// of `paper`, and for a station that alone is held.
    std::optional<MilliGal> left_out, u_left_out;
    /// Effective degrees of freedom of u_gravity, and the factor of a coverage of 95 %.  Absent
    /// without u_gravity.  `network`: degrees of freedom of the adjustment, and 2, because u is a
    /// priori; absent if the global test fails.
    std::optional<double> dof, coverage_factor;
    std::optional<StationErrors> errors;  ///< `day` only.
    /// Errors of left_out; for the only station that is held, those of its reference.  `day` only.
    std::optional<SharedErrors> shared;
    /// Present if they are asked for, and latitude and altitude are known.
    std::optional<Anomalies> anomalies;
};

/// Gravity of station `to` minus gravity of station `from`.
///
/// `day` and the linear models hide the references of both; `network` adjusts with all of them.
struct StationDifference {
    std::string from, to;
    MilliGal difference;
    MilliGal u;                         ///< Standard uncertainty.
    std::optional<MilliGal> reference;  ///< Difference of the references, if both have one.
};

/// Returns the difference of two stations, with that of their references if both have one.
[[nodiscard]] inline StationDifference difference_of(const StationValue& from,
                                                     const StationValue& to, MilliGal difference,
                                                     MilliGal u) {
    StationDifference result{from.site, to.site, difference, u, std::nullopt};
    if (from.reference && to.reference) result.reference = *to.reference - *from.reference;
    return result;
}

/// Covariance of stations' values.
struct StationCovariance {
    std::vector<std::string> sites;
    /// (sites, sites) Of StationValue::left_out for `day`, else of StationValue::gravity.
    Eigen::MatrixXd mgal2;
};

/// A coefficient of the model.
struct Coefficient {
    std::string name;  ///< Name with its unit.
    double value = 0.0;
    std::optional<double> standard_error;         ///< Absent if not estimated, or if dof is 0.
    std::optional<adjustment::Prior> prior = {};  ///< As given; absent without one.

    /// Returns the distance from the prior's mean, in its standard deviations; 0 without a prior.
    [[nodiscard]] double deviations() const {
        return prior ? std::abs(value - prior->mean) / prior->sd : 0.0;
    }
};

/// The scale factor of an instrument: change of the reading divided by that of gravity.
struct ScaleEstimate {
    std::string instrument;  ///< Name of the gravimeter; empty for the sensor.
    double value = 1.0;
    double u = 0.0;  ///< Standard uncertainty, at most that of the prior.
    adjustment::Prior prior;

    /// Returns the share of the prior's variance that is left: 1 if the readings contain nothing about
    /// the scale.
    [[nodiscard]] double prior_share() const { return u * u / (prior.sd * prior.sd); }
    /// Returns the 95 % limits.
    [[nodiscard]] Interval limits() const {
        return {value - kCoverageFactor * u, value + kCoverageFactor * u};
    }
};

/// Test of the difference between the readings' estimates and the calibration.
struct Disagreement {
    /// s' D^-1 s of the shift s from prior to posterior, D = prior - posterior covariance.
    ///
    /// If the calibration is true, it has the chi-square distribution with `dof`.
    double chi_square = 0.0;
    std::size_t dof = 0;  ///< Number of directions about which the readings contain information.
    double p = 1.0;       ///< Probability of at least this difference by chance.
};

/// Use and effect of the calibration.
struct CalibrationUse {
    /// True: prior of the whole-day model.  False: axis biases were fixed, the thermal part not
    /// used.
    bool is_prior = false;
    std::optional<Disagreement> axis_bias, thermal;  ///< Tests; present for priors only.
    /// Change of the corrected values, rms; with fixed biases the scatter of the tilt correction.
    double effect_rms_mgal = 0.0;
    /// Leave-one-station-out error without the calibration; present for priors, and only if the day
    /// has a LOSO.
    std::optional<double> loso_without_mgal;
};

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

/// Returns true if the sensor was turned over between readings.
[[nodiscard]] bool has_two_faces(const std::vector<CorrectedRow>& rows);

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
    /// Returns true if v^T W v is below the lower limit: readings scatter less than stated.
    [[nodiscard]] bool scatters_less_than_stated() const {
        return dof > 0 && weighted_square < chi_square_low;
    }
};

/// Values that only `day` gives, besides those in the rows.
struct WholeDayPart {
    std::vector<whole_day::FitTest> fit_tests;  ///< Empty: there are too few readings to test.
    /// Factor by which the uncertainties of stations and differences are multiplied; 1 unless the
    /// model does not fit.
    double uncertainty_factor = 1.0;
    whole_day::UnitPosterior unit;   ///< Parameters of the unit, as the day has found them.
    whole_day::SurveyPoint point{};  ///< Most likely lags and noise.
};

/// A model fitted to a survey.
struct Fit {
    /// All rows in order of time, in use or not, except those in `left_out`.
    std::vector<CorrectedRow> rows;
    /// Occupations that have no row, or that cannot be corrected.
    std::vector<reading::LeftOut> left_out;
    std::vector<reading::Finding> findings;  ///< What is wrong with the survey, the worst first.
    std::vector<StationValue> stations;      ///< In order of their first row.
    /// Differences of all pairs of stations, in the order of the stations; none for `paper`.  A
    /// station with flagged rows only is in none.
    std::vector<StationDifference> differences;
    /// Present if there are differences.
    std::optional<StationCovariance> covariance;
    std::vector<Coefficient> coefficients;  ///< In the order of the model.
    std::vector<ScaleEstimate> scales;  ///< One per instrument; empty: a model without this term.
    Score score;                        ///< Score on the rows of the fit.
    std::optional<Interval> loo_interval_mgal;  ///< 95 % limits of LOO; linear models only.
    std::vector<text::Message> remarks;         ///< Further facts for the user, in sentences.
    /// Present if the options have a calibration and the model is `day`, or the fit is that of
    /// correct_with_calibration().
    std::optional<CalibrationUse> calibration;
    /// Values that only one model gives.
    std::variant<std::monostate, NetworkPart, WholeDayPart> own;

    /// Returns the values of one model; null if another model was fitted.  The pointer is into this
    /// object.
    template <class Part>
    [[nodiscard]] const Part* as() const {
        return std::get_if<Part>(&own);
    }
};

/// Scores of models on one set of rows.
struct ScoredRowSet {
    std::string rows;  ///< "used": rows that are not flagged; "all": flagged rows too.
    /// Scores in the order of models().  The applied model is last, unless it is always scored.
    std::vector<Score> scores;
};

/// A station measured by the sensor and by a reference gravimeter.
struct ComparedStation {
    std::string site;
    MilliGal ours, u_ours;      ///< Value of the sensor with this station's reference hidden.
    MilliGal theirs, u_theirs;  ///< Adjusted value of the gravimeter.

    /// Returns ours minus theirs.
    [[nodiscard]] MilliGal difference() const { return ours - theirs; }
};

/// Comparison of the sensor with reference gravimeters at the same stations.
struct SideBySide {
    std::vector<ScaleEstimate> scales;  ///< Scales of the gravimeters, one per instrument.
    /// True: a station has a published gravity.  False: the level is that of the sensor's readings at
    /// the first common station, so that its bias is not known.
    bool is_level_known = false;
    std::size_t reading_count = 0;          ///< Number of the gravimeters' readings.
    std::optional<double> s0;               ///< A posteriori factor of the gravimeters' adjustment.
    std::optional<Coefficient> bias;        ///< Constant of the sensor; absent without a level.
    std::vector<ComparedStation> stations;  ///< In the order of the survey's stations.

    /// Returns the rms of ours minus theirs, mGal; absent without a station.
    [[nodiscard]] std::optional<double> scatter_mgal() const {
        if (stations.empty()) return std::nullopt;
        double squares = 0.0;
        for (const ComparedStation& station : stations)
            squares += station.difference().value() * station.difference().value();
        return std::sqrt(squares / static_cast<double>(stations.size()));
    }
};

/// Result of correct_survey(): a fit, and how its model was chosen.
///
/// Compare models within one row set only: scores of different rows are not comparable.
struct SurveyCorrection : Fit {
    SurveyOptions options;                   ///< Options as applied; `base` is filled in.
    std::string model;                       ///< Name of the model; with `auto` the chosen one.
    std::vector<ScoredRowSet> row_sets;      ///< Two sets: used, all.
    std::optional<Choice> choice;            ///< `auto` only, if not the whole-day model.
    std::optional<double> choice_loso_mgal;  ///< `auto` only: LOSO of choosing and fitting.
    std::optional<SideBySide> side_by_side;  ///< Present if the survey has reference gravimeters.
};

}  // namespace a351::corrector::model
