#pragma once
/// @file
/// From a data root to the rows of a survey.
///
/// This is the first half of the command `survey`: everything up to the readings, before tide and
/// fit.  It has two steps, so that mistakes in the small files are found before the archive is
/// read:
///
///     const SurveyStays stays = read_survey_inputs(source);
///     OccupationRows result = average_occupations(source, stays, progress);
///     apply_tide(result.rows, result.sites, choice, &*result.day);       // tide_choice.hpp
///
/// The same files give the same bits on any number of cores (archive_survey_test.cpp: two runs).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/archive_series/on_all_cores.hpp"
#include "corrector/archive_series/temperature_course.hpp"
#include "corrector/archive_series/unit_spans.hpp"
#include "corrector/reading/amendments.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/occupation_list.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/survey_row.hpp"
#include "corrector/reading/signal_course.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::reading {

/// Files of a survey's readings, and the options of their average.
/// Only `root` and `sites` must be set.  Paths are used as they are; relative ones refer to the
/// current directory.
struct SurveySource {
    /// File that names the others, for messages; empty if there is none.
    std::filesystem::path path;
    std::filesystem::path root;         ///< Data root with archive/, metadata/, events/.
    std::filesystem::path sites;        ///< CSV of the benchmarks.
    std::filesystem::path occupations;  ///< CSV; empty: the event log of the root.
    std::filesystem::path amendments;   ///< TOML for amend(); empty: none.
    /// Start of the time in which occupations must start.  Without `from` and `to`: all of a table,
    /// or the last survey day of the log.
    std::optional<UtcTime> from;
    std::optional<UtcTime> to;  ///< End of this time, not included.
    /// Serial number of the sensor whose set-ups are read; empty: all are of one sensor.
    std::string unit;
    /// True while the daemon records: an occupation that runs is used up to the last sample, and
    /// samples that have not reached the archive are taken from the journal.
    bool is_so_far = false;
    std::optional<UtcTime> running_until;  ///< End of an occupation that runs, if is_so_far.
    /// True if the sensor was laid down in several positions: the axis that the metadata call vertical
    /// is z, whichever axis gravity is along.
    bool is_tumbled = false;
    /// Options of every average.  averaging.cutoff_s is checked when the first one is computed.
    RepresentativeOptions averaging;
};

/// The stays of a survey and the sensor that recorded them; no sample has been read yet.
/// Invariant of the result of read_survey_inputs(): list.windows is not empty and in order of
/// start.
struct SurveyStays {
    std::vector<text::Site> sites;   ///< Table of the sites, with the references as amended.
    OccupationList list;             ///< Possible set-ups, amended.
    Amendments amendments;           ///< Amendments carried out; empty without a file.
    std::filesystem::path metadata;  ///< StationXML that was read.
    archive_series::Epoch epoch;     ///< Sensor and scales at the first set-up.
    std::vector<archive_series::UnitSpan> units;  ///< Which sensor recorded when.
    std::vector<Finding> findings;                ///< That the day has several sensors, if so.
};

/// The readings of a survey.
/// Invariant: rows and records have the same length, at least 1, and element i of both is one
/// set-up.  It owns everything; nothing refers to the source.
struct OccupationRows {
    std::vector<SurveyRow> rows;               ///< In order of time, with references; tides are 0.
    std::vector<RepresentativeValue> records;  ///< Record of each row.
    /// Temperature over the whole survey.
    std::vector<archive_series::MinuteTemperature> temperature_course;
    std::vector<SignalSpan> signal;      ///< Words of the recorder in this time, if logged.
    std::optional<DayRecord> day;         ///< Set-ups numbered as the rows; absent: no temperature.
    std::vector<LeftOut> left_out;        ///< Occupations without a value, by start.
    std::vector<text::Message> warnings;  ///< Doubts and omissions, with reasons.
    std::vector<Finding>
        findings;  ///< Moved boxes, stay_remarks(), start_up_findings(), other units.
    Amendments amendments;
    std::vector<text::Site> sites;        ///< With the references as amended.
    std::vector<text::InputFile> inputs;  ///< All files that were read; empty if is_so_far.
    std::string running_key;              ///< Key of the stay that still runs; may be empty.
    std::optional<UtcTime> data_end;      ///< Last sample of the vertical axis that was read.
    /// Newest clock reading that the journal had when it was read; absent unless is_so_far.  A copy
    /// of the root made at this instant gives the same rows.
    std::optional<UtcTime> as_of;
    std::string serial_number;  ///< Sensor; empty if not in the metadata.
    /// Noise of an axis by the data sheet of its profile; absent if that is not known.
    std::optional<double> data_sheet_mgal_per_sqrt_hz = {};
};

/// Reads the table of sites, the occupations and the station's metadata.
///
/// The occupations are from source.occupations, or else from the events of the root.  They are
/// amended, and impossible ones are left out.  The metadata is metadata/station.xml of the root,
/// with the epochs in force at the first set-up.
///
/// A set-up is of the sensor that recorded at its start; it ends when another one begins.  Those of
/// other sensors than source.unit are removed.
///
/// @throws Refused     no occupation is possible, or there are no metadata yet.
/// @throws InputError  one of them cannot be read or has a mistake, or a channel is missing; or the
///                     set-ups are of several sensors and source.unit is empty.
[[nodiscard]] SurveyStays read_survey_inputs(const SurveySource& source);

/// Returns the serial numbers of the sensors that have set-ups in the survey, by the end of their last
/// one; source.unit is not used.
/// @throws InputError  as read_survey_inputs().
[[nodiscard]] std::vector<std::string> units_of(const SurveySource& source);

/// Averages every occupation, on all cores.  The result does not depend on their number.  The tide
/// is left zero.
///
/// Every channel is read once, from the first set-up to the last with a minute on either side.  The
/// temperature begins eight hours earlier.  All samples of this time are in memory at once.
///
/// A set-up without samples, with fewer than 16 decimated samples in a row, or without temperature
/// has no row.  It is in `left_out` with the reason, and in the warnings.  Damage in the archive is
/// a warning.  The other set-ups are averaged nevertheless.
///
/// `day` is absent with less than ten minutes of temperature.  Its bins have the index of their row
/// as number of the set-up.
///
/// @param source    the one of which `stays` was read.
/// @param stays     from read_survey_inputs().
/// @param progress  called after each set-up, from any thread, never from two at once; not empty.
/// @throws Refused                no occupation has a value.
/// @throws std::invalid_argument  averaging.cutoff_s is out of range.
/// @throws std::system_error      a file of the archive cannot be read, or no thread started.
[[nodiscard]] OccupationRows average_occupations(const SurveySource& source,
                                                 const SurveyStays& stays,
                                                 const archive_series::Progress& progress);

}  // namespace a351::corrector::reading
