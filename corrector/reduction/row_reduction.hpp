#pragma once
/// @file
/// Reduction of the readings from the sensor to the mark, and to the pressure of the standard
/// atmosphere:
///
///     acceleration = measured + gradient height - admittance (p - p_n)
///
/// height is that of the sensor above the mark; p is the air pressure and p_n that of the standard
/// atmosphere at the altitude of the site.
///
///     ReductionChoice choice;
///     choice.pressure = "pressure.csv";
///     const auto warnings = reduce_rows(rows, sites, gradients, choice, day);

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/day_record.hpp"
#include "corrector/reading/survey_row.hpp"
#include "corrector/reduction/air_pressure.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::reduction {

/// Decrease of gravity per metre upwards where a site has no measured one, mGal/m.
/// Source: gradient of normal gravity at 45 degrees; real ones differ by up to a fifth.
inline constexpr double kNormalGradient_mgal_per_m = 0.3086;

/// Effect of the air on gravity, mGal/hPa: less gravity with more air above.
/// Source: G. Boedecker, International Absolute Gravity Basestation Network, BGI Bull. d'Information
/// 63, 51-57, 1988; real ones are -0.0002 to -0.0004.
inline constexpr double kAdmittance_mgal_per_hpa = -0.0003;

/// Limits of an admittance, mGal/hPa.  Reason: a free plate of air has -0.00043.
inline constexpr double kLeastAdmittance_mgal_per_hpa = -0.001,
                        kGreatestAdmittance_mgal_per_hpa = 0.0;

/// Choices of the user for all rows; a row's own height and pressure have priority.
struct ReductionChoice {
    std::optional<Metres> height;    ///< Height of the sensor in rows that give none.
    std::filesystem::path pressure;  ///< CSV for AirPressure::read(); empty: that of the rows.
    std::optional<PressureChannel> pressure_channel = {};  ///< Instead of the CSV.
    double admittance_mgal_per_hpa = kAdmittance_mgal_per_hpa;
    /// True: the network fits the admittance, and the readings are not reduced for the pressure.
    bool is_admittance_fitted = false;
};

/// Gradients by site, mGal/m; sites without one are absent.
using Gradients = std::map<std::string, double>;

/// Reads the column gradient_mgal_per_m of a table of sites, which may be absent; empty cells too.
/// @throws InputError  a number outside 0.1 to 0.6: the decrease upwards is positive.
[[nodiscard]] Gradients read_gradients(const std::filesystem::path& sites);

/// Reduces the readings.  Adds to `acceleration` and to the day's bins; sets height_correction if
/// any row has a height, and pressure_correction and excess_pressure_hpa if any has a pressure.
///
/// A reading without a height is taken as at the mark, and one without a pressure as at that of the
/// standard atmosphere, with a warning.  A bin has the correction of its row.
/// @param rows       any order; those of one day.
/// @param sites      sites of all rows.
/// @param gradients  read_gradients() of the same table.
/// @param day        record of these rows; null: there are only averages.
/// @return warnings, in sentences.
/// @throws InputError  as AirPressure::read(); no pressure, if the admittance is fitted; a pressure so far from the standard one that altitude
///                     and pressure do not belong together (kMostExcess_hpa).
[[nodiscard]] std::vector<text::Message> reduce_rows(std::vector<reading::SurveyRow>& rows,
                                                     const std::vector<text::Site>& sites,
                                                     const Gradients& gradients,
                                                     const ReductionChoice& choice,
                                                     reading::DayRecord* day = nullptr);

/// Adds the choice to the settings of a result: instrument_height_m, pressure and
/// admittance_mgal_per_hpa.
void describe_reduction(nlohmann::ordered_json& settings, const ReductionChoice& choice);

}  // namespace a351::corrector::reduction
