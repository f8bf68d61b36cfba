#pragma once
/// @file
/// A survey after the fit of one model: values that every model gives, and values of one model
/// only.
///
/// Values that only one model gives are in a variant, which as() reads:
///
///     if (const auto* const day = row.as<WholeDayRow>()) day->flicker_correction;
///     if (const auto* const network = fit.as<NetworkPart>()) network->s0();
///
/// An absent value means that it is not defined for this row or model; it never means 0.  All types
/// own their content and have no references to the input.
/// Methods and sources: corrector/methods.md.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "corrector/adjustment/prior.hpp"
#include "corrector/model/corrected_row.hpp"
#include "corrector/model/network_part.hpp"
#include "corrector/model/score.hpp"
#include "corrector/model/station_value.hpp"
#include "corrector/model/survey_options.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/whole_day/goodness_of_fit.hpp"
#include "corrector/whole_day/unit_posterior.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

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

    /// Returns the value of a station; null if the survey has none.
    [[nodiscard]] const StationValue* station(const std::string& site) const {
        const auto found = std::ranges::find(stations, site, &StationValue::site);
        return found == stations.end() ? nullptr : &*found;
    }
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
        std::vector<double> differences_mgal;
        for (const ComparedStation& station : stations)
            differences_mgal.push_back(station.difference().value());
        return root_mean_square(differences_mgal);
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
