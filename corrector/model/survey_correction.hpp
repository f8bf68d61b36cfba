#pragma once
/// @file
/// From rows to gravity: fits one model, corrects every row and scores all models.
///
///     corrected = acceleration - tide + temperature_correction + rate_correction +
///     drift_correction
///                 (+ tilt_correction + flicker_correction, if present)
///     residual  = reference - corrected
///
/// The tide is the effect on gravity and is subtracted; every correction is added.
/// Methods and sources: corrector/methods.md.

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/model_fit.hpp"
#include "corrector/model/network.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

/// Returns the names that SurveyOptions::model may have: auto, paper, day, those of kLinearModels
/// and kModelsOnRequest, network, robust.
[[nodiscard]] std::vector<std::string> model_names();

/// Options of a correction.
struct SurveyOptions {
    std::string model = "auto";  ///< One of model_names().
    std::string base;            ///< Station of the drift step; empty: that of the first row.
    /// Stations whose reference is held; empty: all that have one.
    std::vector<std::string> datum;
    bool use_flags = true;                ///< True: flagged rows are not in the fit.
    NetworkOptions network;               ///< Options of `network`.
    std::string robust_terms = "t-rate";  ///< Linear model that `robust` fits.
    std::uint64_t seed = 1;               ///< Seed of the bootstrap over stations.
    ModelPriors priors;  ///< Priors of the linear models and the network; `paper` uses none.
    std::optional<Calibration> calibration;  ///< Calibration of the unit.
};

/// Values of a row that only the whole-day model gives.
struct WholeDayPart {
    double averaged_s = 0.0;            ///< Sum of the durations of the undisturbed samples.
    double fast_rate_degc_per_h = 0.0;  ///< Rate of the temperature in the fast term.
    MilliGal flicker_correction;
    std::optional<MilliGal> left_out;  ///< Value with the reference of the station hidden.
};

/// A row with its corrections.  The constant of the model belongs to the temperature correction.
struct CorrectedRow {
    SurveyRow row;
    bool is_used = false;                ///< True for a row in the fit.
    std::optional<MilliGal> difference;  ///< acceleration - reference - tide.
    MilliGal temperature_correction;
    MilliGal rate_correction;
    MilliGal drift_correction;
    /// Present in every row or in none: `day`, `t-rate-drift-axes`, or with a calibration.
    std::optional<MilliGal> tilt_correction;
    MilliGal corrected;                ///< acceleration - tide + all corrections.
    std::optional<MilliGal> residual;  ///< reference - corrected.
    /// Leverage; for a row outside the fit, LinearFit::leverage_at() of it.  Absent for `day`.
    std::optional<double> leverage;
    /// Uncertainty as if the station were unknown: s sqrt(1 + leverage).  `network` and `day`: see
    /// correct_network(), correct_by_day().
    std::optional<MilliGal> u_corrected;
    /// Studentised residual: external, except `robust` (scale of the robust fit); absent for
    /// `paper`.
    std::optional<double> studentised_residual;
    std::optional<MilliGal> corrected1;  ///< `paper` only: Corrected (1), before the drift step.
    std::optional<double> weight;     ///< `robust` only, rows in use: 1 counts fully, 0 not at all.
    std::optional<WholeDayPart> day;  ///< `day` only: in every row.
    /// Reasons from outlier_tests.hpp; empty if there are none.  No row is left out because of
    /// them.
    std::string doubt_physical;
    std::string doubt_statistical;

    /// Returns reference - corrected1, the publication's Error (1) (Table 2); `residual` is its
    /// Error (2).
    [[nodiscard]] std::optional<MilliGal> residual1() const {
        if (!row.reference || !corrected1) return std::nullopt;
        return *row.reference - *corrected1;
    }

    /// Returns the tilt correction, 0 if there is none.
    [[nodiscard]] MilliGal tilt_correction_or_zero() const {
        return tilt_correction.value_or(MilliGal(0.0));
    }
};

/// The value of a station.
struct StationValue {
    std::string site;              ///< Name of the station.
    std::size_t row_count = 0;     ///< Number of rows averaged.
    bool is_flagged_only = false;  ///< True: no row is unflagged; the flagged are averaged.
    MilliGal gravity;              ///< Mean of its corrected values; `network`: adjusted value.
    /// Uncertainty s sqrt(1/n + leverage of the mean row); `network`: a priori.
    std::optional<MilliGal> u_gravity;
    std::optional<MilliGal> u_a_posteriori;  ///< `network` only: s0 times u_gravity.
    std::optional<MilliGal> reference;       ///< Known gravity.
    std::optional<MilliGal> residual;        ///< reference - gravity.
    std::optional<double> redundancy;        ///< Sum of 1 - leverage over its rows in the fit.
};

/// A coefficient of the model.
struct Coefficient {
    std::string name;  ///< Name with its unit.
    double value = 0.0;
    std::optional<double> standard_error;
};

/// Scores of all models on one set of rows.
struct ScoredRowSet {
    std::string rows;  ///< "used": rows that are not flagged; "all": flagged rows too.
    std::vector<ModelScore> scores;
};

/// Test of the difference between the readings' estimates and the calibration.
struct Disagreement {
    /// s' D^-1 s of the shift s from prior to posterior, D = prior - posterior covariance.
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

/// Result of correct_survey(): corrected rows, values of the stations and scores.
struct SurveyCorrection {
    SurveyOptions options;  ///< Options as applied; `base` is filled in.
    std::string model;      ///< Model that was applied; with `auto` the chosen one.
    std::vector<Coefficient> coefficients;
    std::vector<CorrectedRow> rows;
    /// Occupations without a row, by start.  correct_survey() adds those that `network` leaves out.
    std::vector<LeftOut> left_out;
    std::vector<StationValue> stations;
    std::vector<ScoredRowSet> row_sets;         ///< Two sets: used, all.
    ModelScore score;                           ///< Score of `model` on the rows of the fit.
    std::optional<ModelChoice> choice;          ///< `auto` only, if not the whole-day model.
    std::optional<double> choice_loso_mgal;     ///< `auto` only: LOSO of choosing and fitting.
    std::optional<Interval> loo_interval_mgal;  ///< 95 % limits of LOO; linear models only.
    std::optional<NetworkAdjustment> network;   ///< `network` only.
    std::optional<CalibrationUse> calibration;  ///< Present if the options have a calibration.
    std::vector<std::string> remarks;           ///< Further facts for the user, in sentences.
};

/// Adds occupations that have no row, and sorts them by start.
void add_left_out(SurveyCorrection& result, const std::vector<LeftOut>& occupations);

/// Corrects a survey by the model of the options.
///
/// Rows in the fit have a reference, belong to the datum, are not excluded and, with use_flags, not
/// flagged.  All other rows are corrected too and have no influence.  A calibration is not applied
/// to the readings here, except as prior of the whole-day model: see correct_with_calibration().
///
/// `auto` takes the whole-day model if day_refusal() finds no reason against it and there are no
/// priors, else choose_model(); without a choice it takes `t`.
///
/// Accuracy (survey_correction_test.cpp): the corrections add up to the corrected value within
/// 1e-8 mGal; an unknown station of a day without noise comes out within 1e-6 mGal.
/// @param rows     (n) in strictly ascending time, with tide and rates set.
/// @param options  see SurveyOptions.
/// @param day      record of these rows, for the model `day`; null: there are only averages.
/// @throws InputError  if a base or datum station has no row, the model is unknown, there are no or
///                     too few rows for the model, a term does not vary, the drift step of `paper`
///                     is refused, or a network does not determine an unknown.
[[nodiscard]] SurveyCorrection correct_survey(const std::vector<SurveyRow>& rows,
                                              const SurveyOptions& options,
                                              const DayRecord* day = nullptr);

}  // namespace a351::corrector
