#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/representative_value.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Figures of the record behind a row, within its averaging interval unless stated otherwise.
struct RecordSummary {
    MilliGal series_mean;                    ///< Of the decimated series.
    MilliGal curve_mean;                     ///< Of the trend that was asked for.
    MilliGal eemd_mean;                      ///< Of the decomposition's trend.
    MilliGal smoother_mean;                  ///< Of the smoother's trend.
    MilliGal smoother_standard_error;        ///< For white noise.
    std::optional<MilliGal> standard_error;  ///< Of series_mean, from blocks of 60 s.
    DegC temperature_range;
    TemperatureShape temperature_shape = TemperatureShape::monotone;
    SampleCounts counts;     ///< Of the whole occupation.
    AxisSummary x, y, z;     ///< Horizontal, horizontal, along gravity.
    MilliGal rectification;  ///< rectification_bias().

    [[nodiscard]] MilliGal smoother_minus_eemd() const { return smoother_mean - eemd_mean; }
};

/// One occupation, or one set-up of it: averages over an interval without disturbance.
struct SurveyRow {
    std::string site;
    int occupation = 1;            ///< Counts the stays at this site.
    UtcTime time;                  ///< Middle of the averaging interval.
    std::optional<UtcTime> start;  ///< Limits of the averaging interval, where known.
    std::optional<UtcTime> end;
    bool is_flagged = false;         ///< Marked by the operator as not to be used.
    bool is_excluded = false;        ///< By an amendment: in no fit, whatever becomes of flags.
    std::vector<std::string> notes;  ///< Reasons for doubt, e.g. "fallback".
    MilliGal acceleration;           ///< Mean, full value.
    DegC temperature;
    double rate_degc_per_h = 0.0;  ///< Of the temperature.
    std::optional<MilliGal> given_tide;
    MilliGal tide;                      ///< Effect on gravity; to be subtracted.
    std::optional<MilliGal> reference;  ///< Known gravity of the site.
    std::optional<RecordSummary>
        record;  ///< In every row of a survey, or in none: a table of averages.

    /// @param wanted_by  opens the message.
    /// @throws InputError  the row is of a table of averages.
    [[nodiscard]] const RecordSummary& axes_for(std::string_view wanted_by) const;
};

/// An occupation that has no row.
struct LeftOut {
    std::string site;
    int occupation = 1;
    UtcTime start;  ///< Of the stay, as it was given.
    UtcTime end;
    std::string reason;  ///< In a few words.
};

/// Reads `site,occupation[,outlier],time_utc|time_jst|time[,earth_tide_mgal],acceleration_mgal,
/// temperature_degc` and brings the rows into the order of time.  A zone written in a cell counts;
/// without one it is the column's, and `time` needs one.  `tide` stays zero, rates are set.
/// @throws InputError  a site that `sites` lacks, two rows at one instant, a number out of range.
[[nodiscard]] std::vector<SurveyRow> read_observations(const std::filesystem::path& file,
                                                       const std::vector<text::Site>& sites);

/// Sets R_i = (T_i - T_{i-1}) / (t_i - t_{i-1}) over all rows, flagged or not; 0 for the first.
/// @param rows  in strictly ascending time.
void set_backward_rates(std::vector<SurveyRow>& rows);

/// A warning for every site of the rows whose position is not known.
[[nodiscard]] std::vector<std::string> position_warnings(const std::vector<SurveyRow>& rows,
                                                         const std::vector<text::Site>& sites);

}  // namespace a351::corrector
