#pragma once
/// @file
/// The interface of all models of the instrument, and their list.
///
/// A new model is a Model in a file of its own, with a function in this header or its own, and a
/// line in models().  Values that it alone gives are a new type of CorrectedRow::own or Fit::own.
///
/// Programs call correct_survey(), which chooses the rows, fits and scores.  Use this interface to
/// treat all models alike:
///
///     const SurveyProblem problem{rows, options, day};
///     const auto fit = find_model("t-rate")->fit(problem, choice);
///     if (const auto* const refusal = std::get_if<Refusal>(&fit)) return refusal->trouble;
///
/// Models have no state.  They exist as long as the program, and any number of threads may call
/// them.  Equal arguments give equal results.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "corrector/adjustment/trials.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/model/refusal.hpp"
#include "corrector/reading/day_record.hpp"

namespace a351::corrector::model {

/// A survey to be corrected.
///
/// The members refer to objects of the caller, which must exist as long as this one.
struct SurveyProblem {
    const std::vector<reading::SurveyRow>& rows;  ///< (n) At least one, in strictly ascending time.
    const SurveyOptions& options;                 ///< `base` is filled in.
    const reading::DayRecord* day;  ///< Record of the rows; null: there are only averages.
    /// Lags and noise of a similar survey day, with which a search may begin; null: not known.
    const whole_day::SurveyPoint* nearby = nullptr;
    /// As whole_day::DaySurvey::temperature.
    std::shared_ptr<const whole_day::LaggedMeans> temperature = {};
};

/// The rows of one fit.
///
/// `network` adjusts the accepted rows; all other models fit those in use.
struct RowChoice {
    std::vector<bool> accepted;  ///< (n) True: not excluded and, with use_flags, not flagged.
    std::vector<bool> in_use;    ///< (n) True: accepted, with a reference of the datum.

    [[nodiscard]] bool operator==(const RowChoice&) const = default;
};

/// Returns the rows of a fit.
/// @param datum      stations whose reference is held; empty: all.
/// @param use_flags  true: flagged rows are not accepted.
[[nodiscard]] RowChoice choose_rows(const std::vector<reading::SurveyRow>& rows,
                                    const std::vector<std::string>& datum, bool use_flags);

/// Returns the names of the rows' stations, in order of their first row.
/// @param among  rows that count; empty: all.
[[nodiscard]] std::vector<std::string> station_names(const std::vector<reading::SurveyRow>& rows,
                                                     const std::vector<bool>& among = {});

/// A fit, or the reason why the rows do not allow one.
using FitResult = std::variant<Fit, Refusal>;

/// A model of the instrument.
struct Model {
    std::string_view name;          ///< Name in options and tables; unique in models().
    bool is_always_scored = false;  ///< True: scored in every survey, whichever model is applied.
    bool has_loops = false;         ///< True: each loop of an instrument has a constant of its own.

    /// Fits the model and corrects all rows.  Physical doubts are not set.
    ///
    /// The score is that of score() for the same rows.  Fit::calibration is set by `day` only.
    /// @throws InputError  the model needs the means of the axes and a row has none.
    std::function<FitResult(const SurveyProblem&, const RowChoice&)> fit;

    /// Returns the score; nullopt if such rows are not scored.
    ///
    /// A score without rms_mgal means that the rows do not determine the model, or that it refuses
    /// them.  The cost is up to one fit without each station and one without each row.
    /// @throws InputError  as fit().
    std::function<std::optional<Score>(const SurveyProblem&, const RowChoice&)> score;

    /// Returns the survey for the search of mistakes; null if the model does not fit it.  Empty for
    /// `paper`.  The problem must exist as long as the result.
    std::function<std::unique_ptr<adjustment::Trials>(const SurveyProblem&, const RowChoice&)>
        trials = {};

    /// Returns the survey for a joint adjustment, with the noise of its own fit; nullopt if it cannot
    /// take part.  Empty for `day`, which takes part with its record, and for `paper`.  The problem must
    /// exist as long as the result.
    std::function<std::optional<adjustment::AdjustedSurvey>(const SurveyProblem&, const RowChoice&)>
        joint = {};
};

/// Returns all models, in the order of model_names().
[[nodiscard]] const std::vector<Model>& models();

/// Returns the model of this name; null if there is none.  kAutomatic is no model.
[[nodiscard]] const Model* find_model(std::string_view name);

/// Name of the choice between the whole-day model, compared_models() and the network.
inline constexpr std::string_view kAutomatic = "auto";
/// Names of the publication's correction, of the whole-day model and of the network.
inline constexpr std::string_view kPaper = "paper", kWholeDay = "day", kNetwork = "network";

/// Returns the names that SurveyOptions::model may have: kAutomatic and the names of models().
[[nodiscard]] std::vector<std::string> model_names();

/// Returns the rows before the fit (n): is_used and difference are set, the corrections are 0.
///
/// Every model begins with them and sets the other values.  Rows without a reference have no
/// difference.
[[nodiscard]] std::vector<CorrectedRow> uncorrected(const SurveyProblem& problem,
                                                    const RowChoice& choice);

/// The publication's correction (paper_correction.hpp).
///
/// The leverage and uncertainty of a row are those of the line.  It refuses rows that do not
/// determine the line, and if find_end_point_drift() does.
///
/// Use it to reproduce the publication.  Its drift depends on two readings only, which makes the
/// result of the published rows worse.  No row has a studentised residual.
[[nodiscard]] Model paper_model();

/// The models of compared_models() and models_on_request() (linear_models.hpp), in this order.
///
/// Those of compared_models() are always scored.  They refuse rows that do not determine the
/// coefficients.  Priors count: with a prior on a slope, fewer rows are enough.
[[nodiscard]] std::vector<Model> linear_models();

/// The network adjustment (network.hpp).
///
/// Use it where most stations are unknown and some are occupied repeatedly, or for several days
/// with a constant of their own.
///
/// - A row's residual is corrected - reference, held or not.  Its leverage is 1 - redundancy;
///   outside the network it is the variance of its corrections divided by sd^2, that of the reading.
/// - A row's u_corrected is sqrt(sd^2 + variance of its corrections), a priori.
/// - Accepted rows are in the network, with or without reference.
/// - Stations in the network have their adjusted value with the uncertainty a priori.  A station
///   that occurs in flagged rows only has the mean of their corrected values.
/// - LOSO predicts every datum with its own reference hidden, v / r of its row; it needs two datum
///   stations.  It agrees with hiding each reference in turn within 2e-4 of its value, because of
///   the scale; within 1e-5 if that is known (network_test.cpp).
/// - Rows of a loop without a reading in the network cannot be corrected: they are in left_out,
///   with a remark.
///
/// It refuses as adjust_network().
[[nodiscard]] Model network_model();

}  // namespace a351::corrector::model
