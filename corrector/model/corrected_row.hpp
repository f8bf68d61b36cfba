#pragma once
/// @file
/// A reading with its corrections.
///
///     corrected = acceleration - tide + temperature_correction + rate_correction
///                 + drift_correction (+ tilt_correction + flicker_correction + scale_correction,
///                 if present)
///     residual  = corrected - reference
///
/// The tide is the effect on gravity and is subtracted; every correction is added.  If the
/// temperature makes a reading 1 mGal too large, its temperature_correction is -1 mGal.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "corrector/adjustment/term.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::model {

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
    bool is_used = false;                ///< True for a row in the fit; `day`: with a reference.
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
    /// Reasons to doubt the row without use of gravity, from judgement::correct_and_search().  No row
    /// is left out because of them.
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

/// Returns true if the sensor was turned over between readings.
[[nodiscard]] bool has_two_faces(const std::vector<CorrectedRow>& rows);

}  // namespace a351::corrector::model
