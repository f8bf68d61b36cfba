#pragma once
/// @file
/// The reading of one occupation: a row of a survey.
///
/// The models work on rows.  They come from records (average_occupations()) or from a table of
/// averages (read_observations()); rows of both kinds are not mixed.
///
///     std::vector<SurveyRow> rows = read_observations(file, sites);
///     apply_tide(rows, sites, choice);              // tide_choice.hpp
///     // corrected = acceleration - tide + corrections of the model

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/representative_value.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::reading {

/// Names by which an amendment finds a set-up: those before all amendments.
struct ListedSetUp {
    std::string site;
    int number = 1;             ///< Number of the stay at the site.
    std::optional<int> set_up;  ///< From 1; absent if the stay has one set-up.
};

/// Names and marks of a set-up that a person gives, the same in its window and in its row.  The
/// set-ups of one stay share `site` and `occupation`.
struct SetUp {
    std::string site = {};     ///< Name in the table of sites; in an event log it may be a slip.
    int occupation = 1;        ///< Number of the stay at this site, from 1.
    std::string key = {};      ///< Key of the stay in the event log; empty if not from there.
    ListedSetUp listed = {};   ///< Names for amendments; no site if there can be none.
    bool is_flagged = false;   ///< Marked by the operator as not to be used.
    bool is_excluded = false;  ///< Excluded from every fit by an amendment.
    std::vector<std::string> notes = {};  ///< Reasons for doubt, e.g. "fallback" or "no-stop".
    /// Tide that came with it, effect on gravity; used by the tide `given` only.
    std::optional<MilliGal> given_tide = {};
    /// Part of the permanent tide that gravity keeps after given_tide, as the table names it; empty: not known.
    std::string given_tide_system = {};
    std::optional<Metres> instrument_height =
        {};  ///< Height of the sensor above the mark, if given.

    [[nodiscard]] bool has_note(std::string_view note) const {
        return std::ranges::find(notes, note) != notes.end();
    }
};

/// The averages of one occupation, or one set-up of it, over an interval without disturbance.
/// The set-ups of one stay differ in `time`.  In a default-constructed row all numbers are 0 except
/// `occupation`.
struct SurveyRow : SetUp {
    UtcTime time;                  ///< Middle of the averaging interval.
    std::optional<UtcTime> start;  ///< Start of the averaging interval, if known; `end` alike.
    std::optional<UtcTime> end;
    /// Mean with the reductions below.  The full value, or from a gravimeter the value above the zero of its own scale.
    MilliGal acceleration;
    int face = 1;  ///< events::face_of(); 1 in a table of averages.
    /// Standard deviation of the average, from the scatter of its readings; 0 if not given.
    MilliGal u_average{};
    std::string instrument;  ///< Name of the gravimeter; empty for the sensor.
    /// Loop of the gravimeter, as the table gives it: within a loop its constant does not change.
    int loop = 0;
    std::size_t table_row = 0;  ///< Number in its table, which need not be in order of time.
    /// Mean temperature of the sensor over the interval; 0 if not given.
    DegC temperature;
    /// False in a table of a gravimeter, which corrects its readings for temperature itself.
    bool has_temperature = true;
    /// Rate of the temperature, degC/h.  From a record: the slope within the interval.  From a
    /// table: that of set_backward_rates(); 0 for a gravimeter.
    double rate_degc_per_h = 0.0;
    std::optional<double> pressure_hpa;  ///< Air pressure at the site, if given.
    /// Air pressure minus that of the standard atmosphere at the altitude of the site.
    std::optional<double> excess_pressure_hpa;
    /// Reductions to the mark and to the pressure of the standard atmosphere, which `acceleration`
    /// contains.  Each is present in all rows or in none.
    std::optional<MilliGal> height_correction, pressure_correction;
    MilliGal tide;                        ///< Effect of the tide on gravity; to be subtracted.
    std::optional<MilliGal> reference;    ///< Known gravity of the site.
    std::optional<MilliGal> u_reference;  ///< Its standard uncertainty, if given.
    bool is_reference_refused = false;    ///< An amendment says that no fit may use the reference.
    /// Record of the row; present in all rows of a survey, absent in all rows of a table of
    /// averages.
    std::optional<RecordSummary> record;

    /// Return the ends of the averaging interval; without one, its middle.
    [[nodiscard]] UtcTime first_instant() const { return start.value_or(time); }
    [[nodiscard]] UtcTime last_instant() const { return end.value_or(time); }

    /// Returns the mean without the effect of the tide.
    [[nodiscard]] MilliGal reduced() const { return acceleration - tide; }

    /// Returns the mean without the reductions, as the instrument showed it.
    [[nodiscard]] MilliGal measured() const {
        const MilliGal none(0.0);
        return acceleration - height_correction.value_or(none) - pressure_correction.value_or(none);
    }

    /// Returns true if a fit may hold the reference.
    /// @param datum  stations whose reference is held; empty: all.
    [[nodiscard]] bool is_datum(const std::vector<std::string>& datum) const {
        return reference && !is_reference_refused &&
               (datum.empty() || std::ranges::find(datum, site) != datum.end());
    }

    /// Returns the record, for a computation that needs the means of the axes.
    /// @param wanted_by  computation, at the beginning of the message.
    /// @return a reference that is valid as long as the row.
    /// @throws InputError  the row is from a table of averages.
    [[nodiscard]] const RecordSummary& axes_for(std::string_view wanted_by) const;
};

/// An occupation that has no row.  It appears in the results with its reason, so that no stay is
/// lost unseen.
struct LeftOut {
    std::string site;      ///< Name as logged, which may be a slip.
    int occupation = 1;    ///< Number of the stay at this site.
    UtcTime start;         ///< Start of the stay as given.
    UtcTime end;           ///< End of the stay as given.
    std::string reason;    ///< Reason in a few words.
    std::string key = {};  ///< Key of the stay in the event log; empty if not from there.
};

/// Returns true for set-ups, findings or whatever else has a site and an occupation, of the same stay.
[[nodiscard]] bool is_same_stay(const auto& one, const auto& other) {
    return one.site == other.site && one.occupation == other.occupation;
}

/// Returns the name of a stay, as "No.5 (2)".
[[nodiscard]] std::string stay_name(const std::string& site, int occupation);

/// Greatest height of a sensor above or below its mark, m.  Reason: a gravimeter on its tripod is
/// below 1 m, and the gradient is not constant over more than a few metres.
inline constexpr double kGreatestInstrumentHeight_m = 10.0;

/// Limits of an air pressure, hPa.  Reason: on Mount Everest it is 330; the standard atmosphere has 1778
/// at -5000 m, the lowest altitude of a site.
inline constexpr double kLeastPressure_hpa = 300.0, kGreatestPressure_hpa = 1800.0;

/// Returns the cell instrument_height_m of a row, if it is not empty.
/// @param table  must have the column.
/// @throws InputError  not a number, or beyond kGreatestInstrumentHeight_m.
[[nodiscard]] std::optional<Metres> instrument_height(const text::CsvTable& table, std::size_t row);

/// Reads a table `site,occupation[,outlier],time_utc|time_jst|time[,earth_tide_mgal[,tide_system]],
/// acceleration_mgal,temperature_degc[,instrument[,loop]][,instrument_height_m][,pressure_hpa]
/// [,sd_mgal[,readings]]` and sorts its rows by time.
///
/// A zone in a cell has priority; without one the zone of the column applies.  Cells of `time` must
/// have a zone.  `tide` is left zero; rates are set by set_backward_rates().
///
/// Permitted are 900 000 to 1 100 000 mGal, -60 to 100 degC and a tide of -1 to 1 mGal.  The number
/// of the stay is from 1 to 10^6, and `outlier` is 0 or 1 (1 is flagged).  The height is -10 to 10 m,
/// the pressure 300 to 1800 hPa, and both can be empty.  Other cells must not be empty;
/// other columns are ignored.  `time` is the middle of the average; `start`, `end` and `record`
/// stay absent.
///
/// With the column `instrument` the rows are of gravimeters: readings from -20 000 mGal on are
/// permitted, and the temperature may be empty in all rows.  `loop` is then from 0 to 10^6.
///
/// `sd_mgal` is the scatter of the `readings` averaged, of which there is one if the column is absent:
/// u_average is sd / sqrt(readings).  The cell may be empty.
///
/// @param file   CSV with one row per occupation, in any order.
/// @param sites  table of the sites; their gravity becomes the reference of the rows.
/// @return at least one row, in order of time; those of one instrument in strictly ascending time.
/// @throws InputError  a site that `sites` lacks, two rows of an instrument at one instant, a number
///                     out of range, no rows, not exactly one column of time; with file, line,
///                     column and value.
[[nodiscard]] std::vector<SurveyRow> read_observations(const std::filesystem::path& file,
                                                       const std::vector<text::Site>& sites);

/// Sets the temperature rates R_i = (T_i - T_{i-1}) / (t_i - t_{i-1}), degC/h, over all rows,
/// flagged or not; 0 for the first.
///
/// They are crude, because the sensor's temperature is not linear during a drive.  Rows of records
/// have a better rate, which this would overwrite.
/// @param rows  in strictly ascending time; may be empty.  Equal times give infinity or NaN, which
///              is not checked.
void set_backward_rates(std::vector<SurveyRow>& rows);

/// Returns a warning for every site of the rows without a known position, once per site, in order
/// of the rows.  The site has the mean position of the others, which is good enough for the tide
/// and not for a map.  A site that is not in the table gets no warning.
[[nodiscard]] std::vector<text::Message> position_warnings(const std::vector<SurveyRow>& rows,
                                                           const std::vector<text::Site>& sites);

/// Returns warnings about rows of a table that do not fit the others:
/// - each row that is more than 20 days from all others, as with a mistyped year or month;
/// - each row whose temperature is more than 10 degC from the median, and 20 times as far as half of
///   the rows are, as with 0 for an empty cell;
/// - each row at most 12 h after one that is below it in the table, as with the hours of a 12-hour clock,
///   unless the table is grouped by site; without one, the first row that comes less than 8 h after a row of its site and loop with a
///   larger number.  After 8 h it is another day, whose numbers begin with 1;
/// - the sites whose reference is known to more than 1 mGal, as with microgals.  Reason: the worst
///   benchmarks of national nets are known to some tenths.
///
/// Rows of the first three kinds are not named if more than a quarter of the rows are of one.
/// @param rows  in order of time.
[[nodiscard]] std::vector<text::Message> row_warnings(const std::vector<SurveyRow>& rows);

}  // namespace a351::corrector::reading
