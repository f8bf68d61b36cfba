#include "corrector/reduction/row_reduction.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/reduction/plate_and_pressure.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::reduction {
namespace {

/// Limits of a measured gradient, mGal/m.  Reason: measured ones are 0.2 to 0.5.
constexpr double kLeastGradient_mgal_per_m = 0.1, kGreatestGradient_mgal_per_m = 0.6;

/// Greatest difference from the standard atmosphere, hPa.  Reason: at sea level the extremes are 870
/// and 1084 hPa, which is 143 below and 71 above the standard.
constexpr double kMostExcess_hpa = 150.0;

/// Returns true if a row has the value, with a warning if only some of them have it.
/// @param taken_as  words for what the others are.
template <class Row, class Value>
bool is_given(const std::vector<reading::SurveyRow>& rows, std::optional<Value> Row::*value,
              const text::Message& name, const text::Message& taken_as,
              std::vector<text::Message>& warnings) {
    const auto missing = std::ranges::count_if(
        rows, [value](const reading::SurveyRow& row) { return !(row.*value); });
    if (missing == std::ssize(rows)) return false;
    if (missing > 0)
        warnings.push_back(text::message("{} of {} readings have no {}: they are taken as {}",
                                         missing, rows.size(), name, taken_as));
    return true;
}

void reduce_heights(std::vector<reading::SurveyRow>& rows, const Gradients& gradients,
                    std::vector<text::Message>& warnings) {
    if (!is_given(rows, &reading::SurveyRow::instrument_height, "instrument_height_m",
                  text::message("at the mark"), warnings))
        return;
    for (reading::SurveyRow& row : rows) {
        const auto own = gradients.find(row.site);
        const double gradient = own == gradients.end() ? kNormalGradient_mgal_per_m : own->second;
        row.height_correction =
            MilliGal(gradient * row.instrument_height.value_or(Metres(0.0)).value());
        row.acceleration = row.acceleration + *row.height_correction;
    }
}

void reduce_pressures(std::vector<reading::SurveyRow>& rows, const std::vector<text::Site>& sites,
                      double admittance_mgal_per_hpa, std::vector<text::Message>& warnings) {
    if (!is_given(rows, &reading::SurveyRow::pressure_hpa, text::message("air pressure"),
                  text::message("at that of the standard atmosphere"), warnings))
        return;
    for (reading::SurveyRow& row : rows) {
        const text::Site& site = text::required_site(sites, row.site);
        if (row.pressure_hpa && !site.has_altitude)
            throw InputError(row.site +
                             ": its readings have an air pressure, but its altitude is not known; "
                             "allowed: an altitude_m in the list of sites, or no pressure");
        const double normal_hpa = normal_pressure_hpa(site.altitude);
        row.excess_pressure_hpa = row.pressure_hpa.value_or(normal_hpa) - normal_hpa;
        if (std::abs(*row.excess_pressure_hpa) > kMostExcess_hpa)
            throw InputError(fmt::format(
                "{} ({}): pressure_hpa = {}: does not belong to the altitude of the site; allowed: "
                "the pressure at the site, not reduced to sea level, within {} of {:.0f}",
                row.site, row.occupation, *row.pressure_hpa, kMostExcess_hpa, normal_hpa));
        row.pressure_correction = MilliGal(-admittance_mgal_per_hpa * *row.excess_pressure_hpa);
        row.acceleration = row.acceleration + *row.pressure_correction;
    }
}

std::string pressure_name(const ReductionChoice& choice) {
    return choice.pressure_channel ? choice.pressure_channel->name() : choice.pressure.string();
}

}  // namespace

Gradients read_gradients(const std::filesystem::path& sites) {
    const text::CsvTable table = text::read_csv(sites);
    Gradients gradients;
    if (!table.has_column("gradient_mgal_per_m")) return gradients;
    for (std::size_t row = 0; row < table.row_count(); ++row)
        if (const auto gradient =
                table.number_if_given(row, "gradient_mgal_per_m", kLeastGradient_mgal_per_m,
                                      kGreatestGradient_mgal_per_m))
            gradients[table.cell(row, "site")] = *gradient;
    return gradients;
}

std::vector<text::Message> reduce_rows(std::vector<reading::SurveyRow>& rows,
                                       const std::vector<text::Site>& sites,
                                       const Gradients& gradients, const ReductionChoice& choice,
                                       reading::DayRecord* day) {
    std::vector<text::Message> warnings;
    std::optional<AirPressure> pressure;
    if (!choice.pressure.empty()) pressure = AirPressure::read(choice.pressure);
    if (choice.pressure_channel)
        pressure =
            AirPressure::read(*choice.pressure_channel, rows.front().time - kLongestPressureStep,
                              rows.back().time + kLongestPressureStep, warnings);
    for (reading::SurveyRow& row : rows) {
        if (!row.instrument_height) row.instrument_height = choice.height;
        if (!row.pressure_hpa && pressure) row.pressure_hpa = pressure->at(row.time);
    }
    if (pressure && std::ranges::none_of(rows, [](const reading::SurveyRow& row) {
            return row.pressure_hpa.has_value();
        }))
        throw InputError(pressure_name(choice) +
                         ": has no pressure at the time of any reading; allowed: a record of the "
                         "day, in steps of at most 3 h");
    reduce_heights(rows, gradients, warnings);
    reduce_pressures(rows, sites,
                     choice.is_admittance_fitted ? 0.0 : choice.admittance_mgal_per_hpa, warnings);
    const auto no_pressure =
        std::ranges::find_if(rows, [](const reading::SurveyRow& row) { return !row.pressure_hpa; });
    if (choice.is_admittance_fitted && no_pressure != rows.end())
        throw InputError("the admittance cannot be fitted without the air pressure of " +
                         no_pressure->site +
                         "; allowed: pressure_hpa or a file of the pressure for every reading");
    if (day == nullptr) return warnings;
    for (reading::DayBin& bin : day->bins) {
        const reading::SurveyRow& row = rows[bin.set_up];
        bin.reading = bin.reading + (row.acceleration - row.measured());
    }
    return warnings;
}

void describe_reduction(nlohmann::ordered_json& settings, const ReductionChoice& choice) {
    settings["instrument_height_m"] =
        choice.height ? nlohmann::ordered_json(choice.height->value()) : nullptr;
    settings["pressure"] =
        choice.pressure_channel ? pressure_name(choice) : choice.pressure.filename().string();
    if (choice.is_admittance_fitted)
        settings["admittance_mgal_per_hpa"] = "fitted";
    else
        settings["admittance_mgal_per_hpa"] = choice.admittance_mgal_per_hpa;
}

}  // namespace a351::corrector::reduction
