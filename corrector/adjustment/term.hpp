#pragma once
/// @file
/// The terms of the instrument, each declared once: name with unit, column, correction, scope, prior.
///
/// A term's coefficient times its column is an effect on the reading, mGal, which is subtracted.  A
/// model is a list of terms:
///
///     constexpr std::array kTerms{&kConstant, &kTemperature, &kRate};
///
/// Options, CSV, JSON, report and priors read the declarations.  To add a term, declare it here and
/// name it in a model's list.

#include <span>
#include <string>
#include <string_view>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::adjustment {

/// T0, degC.  Reason: near the oven's set point.  The whole-day model has its own T0, 42.5 degC, so
/// the constants of both differ.
inline constexpr DegC kReferenceTemperature{42.6};
/// t0, h after the first row of a loop.  Reason: middle of a survey day.
inline constexpr double kReferenceTime_h = 5.0;

/// The correction to which the effect of a term is added, with the sign turned.
enum class Correction { temperature, rate, drift, tilt, pressure, scale };

/// How far a coefficient reaches: one loop of an instrument, or all loops of the unit.  A survey day is
/// one loop.
enum class Scope { loop, unit };

/// A row, as the column of a term sees it.
struct TermInput {
    const reading::SurveyRow& row;
    double hours = 0.0;          ///< t - t0.
    std::string_view wanted_by;  ///< The model, for messages.
};

/// A term of the instrument.
struct Term {
    std::string_view name;  ///< Name of the coefficient with its unit, as in options and tables.
    Correction correction = Correction::temperature;
    Scope scope = Scope::unit;
    /// Returns the column for a row.  Null for the scale, whose column is the gravity, and for a term
    /// whose column needs the record of the day (whole_day/day_priors.hpp).
    /// @throws InputError  the row lacks a value that the term needs.
    double (*column)(const TermInput&) = nullptr;
};

/// Name of the scale factor: change of the reading divided by that of gravity, without a unit.
inline constexpr std::string_view kScale = "scale";

/// The constant is part of the temperature correction, also in a model without temperature.
extern const Term kConstant;
extern const Term kTime, kTime2, kTime3;  ///< Drift: powers of t - t0, t in h.
extern const Term kTemperature;           ///< T - T0, degC.
extern const Term kRate;                  ///< Rate of the temperature, degC/h.
extern const Term kAxisX, kAxisY;  ///< Means of the horizontal axes, g: biases of a tilted box.
extern const Term kAdmittance;     ///< Air pressure above that of the standard atmosphere, hPa.
extern const Term kScaleTerm;      ///< S - 1, times gravity above g0; one for each instrument.

/// Returns the terms that may have a prior, in the order of options and files.
[[nodiscard]] std::span<const Term* const> terms_with_prior();

/// A step: an unknown offset of all readings of an instrument after an instant, for example after a
/// knock.
struct Step {
    UtcTime time;
    std::string instrument = {};  ///< SurveyRow::instrument; empty for the sensor.

    /// Returns true for a reading with the offset.
    [[nodiscard]] bool is_before(const reading::SurveyRow& row) const {
        return row.instrument == instrument && row.time > time;
    }
};

}  // namespace a351::corrector::adjustment
