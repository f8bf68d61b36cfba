#pragma once
/// @file
/// Prior knowledge of the instrument: priors on coefficients of the linear models and of the
/// network.  Each prior adds one equation, b = mean, with its standard deviation; a reading's equation
/// has that of the reading.
///
/// Use one for a coefficient that is known from elsewhere and that the rows determine badly.  A
/// small sd holds the coefficient.  One far above the error without a prior has hardly any effect.
///
///     Priors priors;
///     set_prior(priors, "--prior", "rate_mgal_per_degc_per_h", {11.2, 0.5});
///
/// The scale always has a prior, because a few known stations hardly determine it.  The whole-day model
/// has priors of its own (day_model.hpp) and takes only that of the scale from here.

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/adjustment/term.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::adjustment {

/// A normal prior, in the unit of its coefficient.
struct Prior {
    double mean = 0.0;  ///< -kGreatestPrior to kGreatestPrior.
    double sd = 1.0;    ///< Standard deviation, kLeastPriorSd to kGreatestPrior.
};

/// Least standard deviation of a prior, in the unit of its coefficient.  Reason: with a smaller one
/// the digits of the readings are lost in the least-squares system.
inline constexpr double kLeastPriorSd = 1e-6;
/// Greatest mean (absolute value) and standard deviation of a prior, in the unit of its
/// coefficient.  Reason: all coefficients of this sensor are far smaller.
inline constexpr double kGreatestPrior = 1e6;

/// Prior of the sensor's scale factor.
inline constexpr Prior kSensorScale{1.0, unit::kUsualScaleDeviation};
/// Prior of a spring gravimeter's scale factor.  Reason: the scales of six CG-6 of one survey differ by
/// up to 7e-4 (tests/golden/foreign), and one of two CG-5 is off by 6.4e-4 (tests/golden/igp).
/// Calibration lines give about 1e-4; a user who has such a result gives it as prior.
inline constexpr Prior kGravimeterScale{1.0, 5e-4};
/// Greatest difference of a scale's mean from 1, and its greatest standard deviation.  Reason: beyond
/// it the reading is not one of gravity, and the linearised adjustment is rough.
inline constexpr double kGreatestScaleError = 0.1;

/// Least standard deviation of a reading or a reference, mGal.  Reason: the resolution of the
/// tables.
inline constexpr double kLeastSd_mgal = 0.001;
/// Usual standard deviation of a reading of a spring gravimeter, mGal: its repeatability in the field.
inline constexpr double kGravimeterReadingSd_mgal = 0.01;
/// Greatest standard deviation of a reading or a reference, mGal.  Reason: with this scatter it is
/// worthless.
inline constexpr double kGreatestSd_mgal = 1000.0;

/// Returns the name of the prior of one instrument's scale: "scale C099".
[[nodiscard]] std::string scale_name(std::string_view instrument);

/// All priors of a survey, and the standard deviation against which they are weighted.
///
/// A default-constructed object has no prior.  Priors of terms that a model does not have are
/// not used; unused_priors() names them.
struct Priors {
    /// Priors by the name of the coefficient, one of terms_with_prior() or scale_name().
    std::map<std::string, Prior, std::less<>> values;

    /// Standard deviation of a reading, mGal; it sets the weight of readings against priors and
    /// datum.  Default: the scatter of the published survey about its known stations.  It must be
    /// above 0; this is not checked.
    double reading_sd_mgal = 2.0;

    /// Factors of standard deviations, by the name of the coefficient (`scale_instrument2` too): a
    /// large one frees a coefficient, a small one holds it.
    std::map<std::string, double, std::less<>> factors;

    /// Returns a prior with the factor of its coefficient.
    [[nodiscard]] Prior in_use(std::string_view name, Prior prior) const;

    /// Returns the prior of a coefficient; null if it has none, or if there is no such coefficient.
    /// The pointer is into this object.
    [[nodiscard]] const Prior* find(std::string_view name) const;

    /// Returns the prior of the scale of an instrument: its own (scale_name()), that of all, or the
    /// usual one.
    /// @param instrument  name of a gravimeter; empty for the sensor.
    [[nodiscard]] Prior scale_of(std::string_view instrument) const;

    /// Returns true if a coefficient other than the scale has a prior.
    [[nodiscard]] bool has_slope() const;
};

/// Returns the names of the priors that a model does not use.
/// @param names  coefficients of the model.
[[nodiscard]] std::vector<std::string> unused_priors(const Priors& priors,
                                                     const std::vector<std::string>& names);

/// Sets the prior of a coefficient by name.  It replaces an earlier one.
/// @param origin  option or key that gives the prior, for messages.
/// @throws InputError  if the name is unknown, or mean or standard deviation is out of range (or
///                     NaN).
void set_prior(Priors& priors, std::string_view origin, std::string_view name, Prior prior);

/// Adds the priors of a unit that nobody has calibrated, where there is none yet: the temperature
/// -29 +- 10 mGal/degC, the drift 0 +- 1 mGal/h.
///
/// -29 mGal/degC is the publication's slope from station to station.  Its deviation, a third,
/// allows for another unit; this is an assumption.  The drift has the prior of the whole-day model.
/// @return all priors in words, such as "temperature_mgal_per_degc -29 +- 10".
std::string add_published_priors(Priors& priors);

/// Reads `name = [mean, sd]` for each of terms_with_prior(); absent keys leave the prior as it is.
/// @param table  table `prior` of a survey file; may be empty.
/// @throws InputError  if there is another key, not exactly two numbers, or a number out of range.
void read_priors(Priors& priors, text::TomlTable table);

}  // namespace a351::corrector::adjustment
