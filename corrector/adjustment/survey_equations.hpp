#pragma once
/// @file
/// The observation equations of a survey: its stations, the terms of its instruments, its readings.
///
///     reading_i - tide_i = g0 + S (g(station_i) - g0) + sum of terms + error_i
///     reference:   g(k) = reference_k +- u_k           one row for each station held
///     prior:       coefficient = mean +- sd            one row for each prior
///
/// A term with the scope of a loop has one coefficient for each loop, the scale S one for each
/// instrument.  References are held exactly (a linear model: the gravity is on the left side) or with
/// their uncertainty (a network: the gravity is an unknown with one more row).
///
/// S times an unknown gravity is not linear.  About approximate values g1 and S1 the row is
///
///     reading_i - tide_i - g0 + (g1 - g0) (S1 - 1) = S1 (g - g0) + (g1 - g0) (S - 1) + ...
///
/// adjust() repeats the adjustment about the values of the round before until they stay.
///
///     const SurveyEquations survey(rows, in_use, design, knowledge);
///     const AdjustedSurvey adjusted = adjust(survey);
///     adjusted.gravity(0);                                // of survey.stations()[0]
///
/// Units: mGal; times in h.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "corrector/adjustment/adjustment.hpp"
#include "corrector/adjustment/prior.hpp"
#include "corrector/adjustment/term.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::adjustment {

/// Pause between two readings that begins a new loop, h.  Reason: it is a night.  Of the surveys in
/// tests/golden the shortest night has 12.9 h; the longest pause of a day has 6.8 h in an excerpt, and
/// 3 h in a whole file.  A date would not do: UTC changes it at noon in some countries, and a table does
/// not have the local one.
inline constexpr double kLoopPause_h = 8.0;

/// Returns the number of the loop of each row, from 0 in order of their first row.  A loop is of one
/// instrument; it ends at a pause of more than kLoopPause_h, and where the table has another loop.
[[nodiscard]] std::vector<std::size_t> loop_numbers(const std::vector<reading::SurveyRow>& rows);

/// The part of a model in the equations.
struct Design {
    std::string name;                ///< Name of the model, for messages.
    std::vector<const Term*> terms;  ///< The scale, if any, is the last one.
    /// True: terms of a loop have a coefficient for each loop.  False: one for the survey.
    bool has_loops = false;
    /// True: references are exact, and readings of other stations are not in the equations.
    bool is_exact = true;
};

/// Knowledge beside the readings.
struct SurveyKnowledge {
    std::vector<std::string> datum;  ///< Stations whose reference is held; empty: all.
    Priors priors;
    std::vector<Step> steps;  ///< In order of time.
    /// Standard deviation of a reference that has none of its own; not for exact ones.
    MilliGal sd_of_reference{};
};

/// A coefficient of the survey.
struct SurveyTerm {
    std::string name;  ///< With `_loop2` or `_instrument2` from the second on; `step_1_mgal`.
    Correction correction = Correction::temperature;
    std::optional<Prior> prior =
        {};  ///< The given prior.  Of a scale it is that of S; the unknown is S - 1.
    bool is_scale = false;
    std::string instrument = {};  ///< Gravimeter of a scale; empty for the sensor.
};

/// A reading in the equations.
struct ReadingRow {
    std::size_t row = 0;                      ///< Number of the survey's row.
    std::optional<std::size_t> station = {};  ///< Unknown gravity; absent for an exact reference.
};

/// A station in the equations.
struct EquationStation {
    std::string site;
    std::optional<MilliGal> held = {};  ///< Reference that is held.
    MilliGal u_held{};
    std::optional<std::size_t> datum_row = {};  ///< Row of the reference.
};

/// The equations of a survey.
class SurveyEquations {
public:
    /// @param rows    (n) in ascending time, kept by reference.
    /// @param in_use  (n) readings of the equations; with exact references each has one.
    SurveyEquations(const std::vector<reading::SurveyRow>& rows, std::vector<bool> in_use,
                    Design design, SurveyKnowledge knowledge);

    [[nodiscard]] const std::vector<reading::SurveyRow>& rows() const { return *rows_; }
    [[nodiscard]] const Design& design() const { return design_; }
    [[nodiscard]] const SurveyKnowledge& knowledge() const { return knowledge_; }
    /// Returns the unknown stations in order of their first reading.
    [[nodiscard]] const std::vector<EquationStation>& stations() const { return stations_; }
    [[nodiscard]] const std::vector<SurveyTerm>& terms() const { return terms_; }
    [[nodiscard]] const std::vector<ReadingRow>& readings() const { return readings_; }
    /// Returns the row of the equations of a survey's row; absent if it is not in use.
    [[nodiscard]] std::optional<std::size_t> equation_of(std::size_t row) const {
        return equation_of_[row];
    }
    /// Returns the loop of each row; absent where no reading of the loop is in use.
    [[nodiscard]] const std::vector<std::optional<std::size_t>>& loops() const { return loops_; }
    [[nodiscard]] std::size_t loop_count() const { return loop_count_; }
    /// Returns the first row of each loop.
    [[nodiscard]] UtcTime origin_of(std::size_t loop) const { return *origins_[loop]; }
    /// Returns g0, from which gravity counts.
    [[nodiscard]] MilliGal origin() const { return origin_; }

    /// Returns the terms of a row, in use or not, numbered as terms().
    [[nodiscard]] const Combination& effects(std::size_t row) const { return effects_[row]; }
    /// Returns the terms of a row as unknowns of the equations.
    [[nodiscard]] Combination effects_as_unknowns(std::size_t row) const;
    /// Returns the unknown of a station's gravity above g0.
    [[nodiscard]] static std::size_t unknown_of_station(std::size_t station) { return station; }
    [[nodiscard]] std::size_t unknown_of_term(std::size_t term) const {
        return stations_.size() + term;
    }

    /// Returns the equations about the present approximate values.
    [[nodiscard]] Equations equations() const;
    /// Returns the name of a row of equations(): `S2 (1)`, `datum S2`, `prior time_mgal_per_h`.
    [[nodiscard]] std::vector<std::string> labels() const;

    /// Sets the approximate values to those of a solution.
    void linearise(const Adjustment& solution);
    /// Sets the approximate values: gravities by site, scales to the means of their priors.
    void linearise(const std::map<std::string, MilliGal>& gravities);
    /// Returns true if the equations depend on approximate values.
    [[nodiscard]] bool is_nonlinear() const;

    /// Returns the standard deviation of a reading, mGal: that of the priors and that of its own
    /// average, times noise().
    [[nodiscard]] double sd_mgal(std::size_t row) const;
    /// Returns the factor of the readings' standard deviations, 1 at first.
    [[nodiscard]] double noise() const { return noise_; }
    void set_noise(double factor) { noise_ = factor; }

private:
    void set_stations();
    void set_terms();
    void set_loops();
    void set_effects();
    void add_steps();
    void set_gravity_columns(const std::vector<double>& gravities_mgal,
                             const std::vector<double>& coefficients);
    [[nodiscard]] std::optional<std::size_t> scale_of(const reading::SurveyRow& row) const;

    const std::vector<reading::SurveyRow>* rows_;
    std::vector<bool> in_use_;
    Design design_;
    SurveyKnowledge knowledge_;
    MilliGal origin_;
    std::vector<EquationStation> stations_;
    std::vector<SurveyTerm> terms_;
    std::vector<ReadingRow> readings_;
    std::vector<std::optional<std::size_t>> equation_of_;
    std::vector<std::optional<std::size_t>> loops_;
    std::size_t loop_count_ = 0;
    std::vector<std::optional<UtcTime>> origins_;
    std::vector<Combination> effects_;
    std::vector<double> scales_;  ///< S1 of each term; 1 for others.
    double noise_ = 1.0;
};

/// A survey and its adjustment.
struct AdjustedSurvey {
    SurveyEquations survey;
    Adjustment adjustment;
    /// How far the last round moved a gravity, mGal.  Above kSettled_mgal: scale and gravities do not
    /// settle, and the values mean nothing.  With exact references nothing is to settle: 0.
    double moved_mgal = 0.0;

    [[nodiscard]] bool is_determined() const { return adjustment.undetermined().empty(); }
    /// Returns the gravity of a station, numbered as SurveyEquations::stations().
    [[nodiscard]] MilliGal gravity(std::size_t station) const {
        return survey.origin() + MilliGal(adjustment.value(station));
    }
    /// Returns the value of a coefficient; of a scale S.
    [[nodiscard]] double coefficient(std::size_t term) const;
    /// Returns the effect of a term on a row, mGal.
    /// @param part  element of SurveyEquations::effects().
    [[nodiscard]] double effect_mgal(const Entry& part) const {
        return part.factor * adjustment.value(survey.unknown_of_term(part.unknown));
    }
};

/// Adjusts a survey.  Accuracy: with a scale within 5 % of 1, the rounds leave less than 1e-9 mGal
/// (network_test.cpp).
[[nodiscard]] AdjustedSurvey adjust(SurveyEquations survey, Cofactor cofactor = Cofactor::computed);

/// Largest number of adjustments, each linearised about the one before.  Reason: the error of a round
/// is that of the one before squared, times 1e-2/mGal at most, so that a usual survey needs four.  The
/// other rounds are for a scale that is 20 % off; one that needs more is contradicted by the readings.
inline constexpr int kScaleRounds = 20;

/// A gravity that moves by less in the last round is settled, mGal.  Reason: a tenth of the last digit
/// that a gravimeter shows.
inline constexpr double kSettled_mgal = 1e-4;

}  // namespace a351::corrector::adjustment
