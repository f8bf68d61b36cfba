#pragma once
/// @file
/// The reading of one occupation: a row of a survey.

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

/// The averages of one occupation, or one set-up of it, over an interval without disturbance.
struct SurveyRow {
    std::string site;
    int occupation = 1;            ///< Number of the stay at this site, from 1.
    UtcTime time;                  ///< Middle of the averaging interval.
    std::optional<UtcTime> start;  ///< Start of the averaging interval, if known; `end` alike.
    std::optional<UtcTime> end;
    bool is_flagged = false;         ///< Marked by the operator as not to be used.
    bool is_excluded = false;        ///< Excluded from every fit by an amendment.
    std::vector<std::string> notes;  ///< Reasons for doubt, e.g. "fallback".
    MilliGal acceleration;           ///< Mean; the full value, not a difference.
    DegC temperature;
    double rate_degc_per_h = 0.0;  ///< Rate of the temperature, degC/h.
    std::optional<MilliGal> given_tide;
    MilliGal tide;                      ///< Effect of the tide on gravity; to be subtracted.
    std::optional<MilliGal> reference;  ///< Known gravity of the site.
    /// Record of the row; present in all rows of a survey, absent in all rows of a table of
    /// averages.
    std::optional<RecordSummary> record;

    /// Returns the record, for a computation that needs the means of the axes.
    /// @param wanted_by  computation, at the beginning of the message.
    /// @throws InputError  the row is from a table of averages.
    [[nodiscard]] const RecordSummary& axes_for(std::string_view wanted_by) const;
};

/// An occupation that has no row.
struct LeftOut {
    std::string site;
    int occupation = 1;
    UtcTime start;       ///< Start of the stay as given.
    UtcTime end;         ///< End of the stay as given.
    std::string reason;  ///< Reason in a few words.
};

/// Reads a table `site,occupation[,outlier],time_utc|time_jst|time[,earth_tide_mgal],
/// acceleration_mgal,temperature_degc` and sorts its rows by time.
///
/// A zone in a cell has priority; without one the zone of the column applies.  Cells of `time` must
/// have a zone.  `tide` is left zero; rates are set by set_backward_rates().
/// @throws InputError  a site that `sites` lacks, two rows at one instant, a number out of range,
///                     no rows.
[[nodiscard]] std::vector<SurveyRow> read_observations(const std::filesystem::path& file,
                                                       const std::vector<text::Site>& sites);

/// Sets the temperature rates R_i = (T_i - T_{i-1}) / (t_i - t_{i-1}), degC/h, over all rows,
/// flagged or not; 0 for the first.
/// @param rows  in strictly ascending time.
void set_backward_rates(std::vector<SurveyRow>& rows);

/// Returns a warning for every site of the rows without a known position.
[[nodiscard]] std::vector<std::string> position_warnings(const std::vector<SurveyRow>& rows,
                                                         const std::vector<text::Site>& sites);

}  // namespace a351::corrector
