#pragma once
/// @file
/// All set-ups of a day at once: what temperature, drift, tilt and noise do to the reading.
///
///     reading = g + tide + c + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///               + d (t - t0) + w exp(-t / 2.5 h) + bx x + by y + placement + flicker + white
///
/// lag: first order, in equilibrium at the begin of the record.  rA: what the thermometer's
/// compensation leaves; rF: crystals that feel a change before the thermometer; rS: an oscillator
/// that feels it later; bx, by: biases of the horizontal axes, which tilting turns into the norm.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_noise.hpp"
#include "corrector/whole_day/day_priors.hpp"

namespace a351::corrector {

/// What is held, or sought, of a set-up.
struct DayStation {
    MilliGal tide;
    std::optional<MilliGal> gravity;  ///< Held.
    std::size_t unknown = 0;          ///< Otherwise: number of the unknown it shares.
};

/// Name and unit, as in result.json.
[[nodiscard]] std::string_view day_term_name(DayTerm term);

struct Estimate {
    double value = 0.0;
    double standard_error = 0.0;
};

/// One set-up with at least one bin; the effects are means over its bins, mGal, as they stand in the
/// reading.
struct DaySetUp {
    bool has_bins = false;
    MilliGal reading;
    DegC temperature;
    double rate_degc_per_h = 0.0;                 ///< (T - lag(T, tF)) / tF.
    std::array<double, kDayTerms> effect_mgal{};  ///< By DayTerm.
    MilliGal flicker;    ///< Estimated, with what of the white noise is left.
    MilliGal corrected;  ///< reading - tide - effects - flicker: gravity and placement.
};

struct DayFit {
    /// Lags, placement, flicker, white: logarithms in standard deviations of their priors.
    using Point = std::array<double, 5>;

    Point point{};
    DayNoise noise;
    double fast_lag_s = 0.0, slow_lag_s = 0.0;
    double log_likelihood = 0.0;                   ///< Restricted, with the priors.
    std::array<Estimate, kDayTerms> coefficients;  ///< Standard errors: those of the lags included.
    std::vector<Estimate> unknown_mgal;            ///< Gravity of each unknown.
    /// Lags and terms after the day, in the coordinates in which their priors are independent
    /// and of variance 1: (estimate - mean) = factor x shift.
    DayPriors::Vector shift = DayPriors::Vector::Zero();
    DayPriors::Matrix shift_covariance = DayPriors::Matrix::Identity();
    std::vector<DaySetUp> set_ups;
};

/// Generalised least squares with priors for the coefficients; lags and noise by the largest
/// restricted likelihood times their priors.
///
/// Usual priors (mean, standard deviation): rA -12, 12 mGal/degC; rF 11.3, 11.3 mGal/(degC/h); rS -20, 20
/// mGal/degC; d 0, 1 mGal/h; w 0, 36 mGal; bx, by 0, 2000 mGal/g.  Log-normal with the factor 1.5:
/// lags 43 s and 2700 s; with the factor 2: placement and flicker 1.2 mGal, white the bins' own scatter.
/// The means are those that explain the publication's long record and survey day (corrector/methods.md).
///
/// @param nearby    a fit of nearly the same, to start from: faster.
/// @param stations  one per set-up, in the record's numbering; unknowns are numbered from 0.
/// @return std::nullopt when no set-up that is held has a bin.
/// Source: H. D. Patterson and R. Thompson, Biometrika 58, 545-554, 1971 (restricted likelihood); C.
/// E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press 2006,
/// section 2.7 (explicit terms with priors).  Maximised by NLopt's Subplex (T. H. Rowan, thesis, Austin 1990) or, from
/// nearby, BOBYQA (M. J. D. Powell, report NA2009/06, Cambridge).
[[nodiscard]] std::optional<DayFit> fit_day(const DayRecord& record,
                                            const std::vector<DayStation>& stations,
                                            const DayFit* nearby = nullptr,
                                            const DayPriors& priors = usual_day_priors());

}  // namespace a351::corrector
