#pragma once
/// @file
/// Model of all set-ups of a day together: effects of temperature, drift, tilt and noise on the
/// reading.
///
///     reading = g + tide + c + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///               + d (t - t0) + w exp(-t / 2.5 h) + bx x + by y + k (g - g0) + steps + placement
///               + flicker + white + oA To + oS lag(To, tO)
///
/// Readings are in mGal, T in degC, rF in mGal/(degC/h), t in h, lags tF and tS in s, x and y in g.
/// A reading is the mean of a bin, and so are T, lag(T, tau), x and y.
/// - T0: 42.5 degC, the set point of the publication's oven.  It only shifts c.
/// - t: time of a bin since the first sample of the temperature record, which counts as power-on.
/// - t0: middle between the first and the last bin of the day.  It only shifts c.
/// - rA, rF, rS, lag(T, tau): the unit's thermal response (protocol/unit/thermal_response.hpp), in
///   equilibrium at the start of the record.
/// - w: warm-up after power-on, which the thermometer does not see.
/// - steps: an unknown offset from each step on (DayStation::steps).
/// - k: scale factor minus 1; g0 is the gravity of the first set-up that is held.
/// - bx, by: biases of the horizontal axes, which a tilt turns into the norm.
/// - placement, flicker, white: noise (day_noise.hpp).
/// - To: temperature of an outer oven, if the box has one; oA and oS in mGal/degC, tO in s.
///
///     std::vector<DayStation> stations;
///     for (const SurveyRow& row : rows)  // one row per set-up
///         stations.push_back({row.reference, stations.size()});
///     stations[3].gravity.reset();       // to be found
///     const auto day = adjust_day({&record, stations});
///     day->gravity(3).value;             // its gravity
///
/// Several surveys are one adjustment: gravities are common to all, and of a unit its lags, slopes (also
/// those by an outer oven), axis biases and scale: what a unit is made of.  Surveys of different units
/// that were at one station at one time are sensors of one box, or boxes side by side: the share of the
/// placement's variance that they have in common decides, and the readings determine it.
///
/// Methods and figures: corrector/methods.md, "The whole-day model" and "Several surveys in
/// one adjustment".

#include <optional>
#include <vector>

#include "corrector/whole_day/day_adjustment.hpp"

namespace a351::corrector::whole_day {

/// Adjusts one survey.
///
/// Coefficients and unknowns: generalised least squares with priors.  Lags and noise: largest
/// restricted likelihood times their priors.  Standard errors: posterior covariance with the lags
/// to first order, at the expected noise, which is larger than the most likely one.
///
/// Stations of known gravity determine the instrument; unknown stations follow from it.  To find the
/// error of the method, fit again with the gravity of a known station removed and compare.
///
/// Usual priors, mean and standard deviation:
/// - rA -12, 7.2 mGal/degC; rS -20, 12 mGal/degC; rF 11.3, 6.8 mGal/(degC/h)
/// - k 0, 0.002
/// - d 0, 1 mGal/h; w 0, 36 mGal; c, unknowns and steps free (0, 1e4 mGal)
///
/// Log-normal priors, median and factor:
/// - lags 43 s and 2700 s, 1.5; tO 1200 s, 2
/// - placement, if it was not measured, and flicker 1.2 mGal, 2; white the scatter of the bins, 2
/// - common standard deviation of bx and by, whose mean is 0, 300 mGal/g, 3
/// - common standard deviation of oA and oS, whose mean is 0, 3 mGal/degC, 3
///
/// The means explain the long record and the survey day of the publication (corrector/methods.md).
///
/// Accuracy (day_model_test.cpp): on a made-up day without placement and flicker, lags come out
/// within 1 % and gravity within 0.001 mGal.  With a placement of 1.2 mGal, the rms error of an
/// unknown station is below 1.6 mGal over 40 days, and 55 to 85 % are within the stated error.  The
/// fit has the same bits each time.  From nearby an unknown agrees within 0.005 mGal.
///
/// Cost: at most 2000 evaluations of the likelihood, each of which filters all bins and columns;
/// time is proportional to the number of bins.  Several threads may call it at a time.
/// @param survey  of one number for unit and gravities.
/// @param nearby  point of a similar problem as start of the search, which is then faster; or null.
///                It should have the same priors, because it counts from them.
/// @return std::nullopt if no set-up that is held has a bin.
/// Source: H. D. Patterson and R. Thompson, Biometrika 58, 545-554, 1971 (restricted likelihood);
/// C. E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press 2006,
/// section 2.7 (explicit terms with priors).  Maximised by NLopt's Subplex (T. H. Rowan, thesis,
/// Austin 1990) or, from nearby, BOBYQA (M. J. D. Powell, report NA2009/06, Cambridge).
[[nodiscard]] std::optional<DayAdjustment> adjust_day(DaySurvey survey,
                                                      const SurveyPoint* nearby = nullptr);

/// Adjusts several surveys together.
///
/// First each survey is adjusted alone.  From there lags and noise are searched that make all readings
/// together most likely (search_together()).  One survey is adjust_day().
///
/// Accuracy (joint_days_test.cpp): two surveys with nothing in common but a station give its weighted
/// mean; likelihood and gravities of a box are those of dense matrices.
/// Order: gravities depend on the order of the surveys by up to 0.02 mGal (joint_days_test.cpp), because
/// the search ends within 0.02 deviations, and because a survey joins the first box with which it shares
/// a set-up.  Sort them for equal bytes.
/// @param surveys        each holds a gravity.
/// @param white_surveys  surveys of other models; there is at least one of either kind.
/// Source: R. Thompson, Biometrics 18, 273-289, 1962, and D. A. Harville, J. Am. Stat. Assoc. 72,
/// 320-338, 1977 (variance components by restricted likelihood); S. S. Wilks, Ann. Math. Stat. 9,
/// 60-62, 1938 (limits by the likelihood ratio).
[[nodiscard]] DayAdjustment adjust_days(std::vector<DaySurvey> surveys,
                                        const std::vector<WhiteSurvey>& white_surveys = {});

/// Returns the adjustment to be expected of a day that is only planned, with a noise that is known.
///
/// The readings of the record are replaced by those that the priors' means give without noise.  An
/// unknown station has the gravity of the first that is held, so that the scale has no part in it.  Lags
/// and size of the axis biases are the medians of the priors.  Values are the priors' means; the
/// standard errors and their sources are those of a day with this noise.  DayFit::noise_log_errors is absent.
///
/// Accuracy (day_model_test.cpp): if priors and noise are those that a day has found, the standard
/// errors agree with those of its fit within 0.1 %.
/// @param record  planned bins with their times and tilts; the readings are set.
/// @param survey  of this record; a value of gravity that is held matters for the scale only.
/// @param noise   each part > 0.
/// @return std::nullopt if no set-up that is held has a bin.
[[nodiscard]] std::optional<DayAdjustment> adjust_planned_day(reading::DayRecord& record,
                                                              DaySurvey survey,
                                                              const DayNoise& noise);

}  // namespace a351::corrector::whole_day
