#pragma once
/// @file
/// From a data root to the rows of a survey.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/amendments.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/reading/occupation_list.hpp"
#include "corrector/reading/occupation_window.hpp"
#include "corrector/reading/on_all_cores.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/survey_row.hpp"
#include "corrector/reading/temperature_course.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Files of a survey's readings, and the options of their average.
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
    RepresentativeOptions averaging;
};

/// The stays of a survey and the sensor that recorded them; no sample has been read yet.
struct SurveyStays {
    std::vector<text::Site> sites;
    OccupationList list;
    std::vector<Amendment> amendments;
    std::filesystem::path metadata;
    record::StationMetadata station;
    SurveyChannels channels;
};

/// The readings of a survey.
struct OccupationRows {
    std::vector<SurveyRow> rows;  ///< In order of time; the rate is that within a row's interval.
    std::vector<RepresentativeValue> records;           ///< Record of each row.
    std::vector<MinuteTemperature> temperature_course;  ///< Temperature over the whole survey.
    std::optional<DayRecord> day;       ///< Set-ups numbered as the rows; absent: no temperature.
    std::vector<LeftOut> left_out;      ///< Occupations without a value, by start.
    std::vector<std::string> warnings;  ///< Doubts and omissions, with reasons.
    std::vector<Amendment> amendments;
    std::vector<text::Site> sites;
    std::vector<text::InputFile> inputs;  ///< All files that were read.
    std::string serial_number;            ///< Sensor; empty if not in the metadata.
};

/// Reads the table of sites, the occupations and the station's metadata.
/// @throws InputError  one of them cannot be read.
[[nodiscard]] SurveyStays read_survey_inputs(const SurveySource& source);

/// Averages every occupation, on all cores.  The result does not depend on their number.  The tide
/// is left zero.
/// @throws InputError  no occupation has a value.
[[nodiscard]] OccupationRows average_occupations(const SurveySource& source,
                                                 const SurveyStays& stays,
                                                 const Progress& progress);

}  // namespace a351::corrector
