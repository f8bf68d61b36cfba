#pragma once
/// @file
/// From rows to gravity: the fit of one model, every correction of every row, scores of all models.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/bootstrap.hpp"
#include "corrector/model/model_fit.hpp"
#include "corrector/model/network.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

/// Names for SurveyOptions::model: auto, paper, day, those of kLinearModels and kModelsOnRequest,
/// network, robust.
[[nodiscard]] const std::vector<std::string>& model_names();

struct SurveyOptions {
    std::string model = "auto";
    std::string base;  ///< Station of the drift step; empty: that of the first row.
    std::vector<std::string>
        datum;              ///< Stations whose reference is held; empty: all that have one.
    bool use_flags = true;  ///< Flagged rows stay out of the fit.
    NetworkOptions network;
    std::string robust_terms = "t-rate";  ///< Linear model that `robust` fits.
    std::uint64_t seed = 1;               ///< Of the resampled stations.
    ModelPriors priors;  ///< Of the linear models and the network; `paper` has none.
    std::optional<Calibration> calibration;  ///< Of the unit.
};

/// Figures of a row that only the whole-day model has.
struct WholeDayPart {
    double averaged_s = 0.0;            ///< Length of the undisturbed samples together.
    double fast_rate_degc_per_h = 0.0;  ///< Rate of the temperature in its fast term.
    MilliGal flicker_correction;
    std::optional<MilliGal> left_out;  ///< Value with the reference of the station hidden.
};

/// A row with its corrections.  corrected = acceleration - tide + the corrections, of which
/// `day` has one of flicker too; the constant is in the temperature correction.
struct CorrectedRow {
    SurveyRow row;
    bool is_used = false;                ///< In the fit.
    std::optional<MilliGal> difference;  ///< acceleration - reference - tide.
    MilliGal temperature_correction;
    MilliGal rate_correction;
    MilliGal drift_correction;
    /// `day`, `t-rate-drift-axes`, or with a calibration: in every row, or in none.
    std::optional<MilliGal> tilt_correction;
    MilliGal corrected;
    std::optional<MilliGal> residual;     ///< reference - corrected.
    std::optional<double> leverage;       ///< Of an unused row: as at its place.  Not for `day`.
    std::optional<MilliGal> u_corrected;  ///< s sqrt(1 + leverage): as of a new station.
    std::optional<double> studentised_residual;  ///< External; not for `paper`.
    std::optional<MilliGal> corrected1;          ///< `paper` only: before the drift step.
    std::optional<double> weight;     ///< `robust` only, rows in use: 1 counts fully, 0 not at all.
    std::optional<WholeDayPart> day;  ///< `day` only: in every row.
    /// Reasons of outlier_tests.hpp, empty when there are none.  They leave no row out.
    std::string doubt_physical;
    std::string doubt_statistical;

    /// reference - corrected1, the publication's Error (1) (Table 2); `residual` is its Error (2).
    [[nodiscard]] std::optional<MilliGal> residual1() const {
        if (!row.reference || !corrected1) return std::nullopt;
        return *row.reference - *corrected1;
    }

    [[nodiscard]] MilliGal tilt_correction_or_zero() const {
        return tilt_correction.value_or(MilliGal(0.0));
    }
};

struct StationValue {
    std::string site;
    std::size_t row_count = 0;     ///< Rows averaged.
    bool is_flagged_only = false;  ///< No row in use: the flagged ones are averaged.
    MilliGal gravity;
    /// s sqrt(1/n + leverage of the mean row); of a network a priori.
    std::optional<MilliGal> u_gravity;
    std::optional<MilliGal> u_a_posteriori;  ///< Of a network: s0 times the former.
    std::optional<MilliGal> reference;
    std::optional<MilliGal> residual;
    std::optional<double> redundancy;  ///< Sum of 1 - leverage over its rows in the fit.
};

struct Coefficient {
    std::string name;  ///< With its unit.
    double value = 0.0;
    std::optional<double> standard_error;
};

struct ScoredRowSet {
    std::string rows;  ///< "used": not flagged; "all": flagged ones too.
    std::vector<ModelScore> scores;
};

/// Whether estimate and calibration differ by more than both are uncertain.
struct Disagreement {
    double chi_square = 0.0;
    std::size_t dof = 0;  ///< Directions in which the readings say anything.
    double p = 1.0;       ///< Of so large a difference by chance.
};

/// What became of the calibration.
struct CalibrationUse {
    bool is_prior = false;  ///< Else the axis biases were held, and the thermal part left alone.
    std::optional<Disagreement> axis_bias, thermal;  ///< As priors only.
    double effect_rms_mgal = 0.0;                    ///< On the corrected values.
    /// Of the day without it, each station left out; as prior only, where stations can be.
    std::optional<double> loso_without_mgal;
};

struct SurveyCorrection {
    SurveyOptions options;  ///< As applied: `base` is filled in.
    std::string model;      ///< Applied; with `auto` the chosen one.
    std::vector<Coefficient> coefficients;
    std::vector<CorrectedRow> rows;
    std::vector<LeftOut> left_out;  ///< By start; correct_survey() knows those of `network` only.
    std::vector<StationValue> stations;
    std::vector<ScoredRowSet> row_sets;         ///< used, all.
    ModelScore score;                           ///< Of `model` on the rows of the fit.
    std::optional<ModelChoice> choice;          ///< `auto` only.
    std::optional<double> choice_loso_mgal;     ///< `auto` only: LOSO of choosing and fitting.
    std::optional<Interval> loo_interval_mgal;  ///< 95 % of `score`'s LOO; least squares only.
    std::optional<NetworkAdjustment> network;   ///< `network` only.
    std::optional<CalibrationUse> calibration;  ///< Where the options have one.
    std::vector<std::string> remarks;           ///< What else has to be known, in sentences.
};

/// Adds occupations that have no row, by start.
void add_left_out(SurveyCorrection& result, const std::vector<LeftOut>& occupations);

/// @param rows  in strictly ascending time, with tide and rates set.
/// @param day   of these rows, for the model `day`; null: there are only averages.
/// @throws InputError  base or datum unknown or without a row, no such model, too few rows for the
///                     model, a term that does not vary, the drift step of `paper` refused,
///                     a network with something open.
[[nodiscard]] SurveyCorrection correct_survey(const std::vector<SurveyRow>& rows,
                                              const SurveyOptions& options,
                                              const DayRecord* day = nullptr);

}  // namespace a351::corrector
