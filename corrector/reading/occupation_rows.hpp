#pragma once

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

/// Where the readings of a survey come from, and how they are averaged.
struct SurveySource {
    std::filesystem::path
        path;  ///< File that names the others, for messages; empty: there is none.
    std::filesystem::path root;         ///< Data root: archive/, metadata/, events/.
    std::filesystem::path sites;        ///< CSV of the benchmarks.
    std::filesystem::path occupations;  ///< CSV; empty: the event log of the root.
    std::filesystem::path amendments;   ///< TOML for amend(); empty: none.
    std::optional<UtcTime> from;        ///< First start of an occupation that is used ...
    std::optional<UtcTime> to;  ///< ... and the first that is not; neither: a log's last day.
    RepresentativeOptions averaging;
};

/// The stays of a survey and the sensor that recorded them; no sample has been read.
struct SurveyStays {
    std::vector<text::Site> sites;
    OccupationList list;
    std::vector<Amendment> amendments;
    std::filesystem::path metadata;
    record::StationMetadata station;
    SurveyChannels channels;
};

struct OccupationRows {
    std::vector<SurveyRow> rows;               ///< With the rate within the interval; by time.
    std::vector<RepresentativeValue> records;  ///< Behind the rows, one each.
    std::vector<MinuteTemperature> temperature_course;  ///< Over the whole survey.
    std::optional<DayRecord> day;       ///< Set-ups numbered as the rows; absent: no temperature.
    std::vector<LeftOut> left_out;      ///< Occupations without a value, by start.
    std::vector<std::string> warnings;  ///< Doubts and omissions, with the reason.
    std::vector<Amendment> amendments;
    std::vector<text::Site> sites;
    std::vector<text::InputFile> inputs;  ///< Every file read.
    std::string serial_number;            ///< Of the sensor; empty: not in the metadata.
};

/// The representative value of a record as a row of the survey, reference and tide left open.
/// @param value  with a temperature.
[[nodiscard]] SurveyRow row_of(const OccupationWindow& window, const RepresentativeValue& value);

/// Reads the table of sites, the occupations and the station's metadata.
/// @throws InputError  one of them cannot be read.
[[nodiscard]] SurveyStays read_stays(const SurveySource& source);

/// Averages every occupation, on all cores; the result does not depend on their number.  The tide stays zero.
/// @throws InputError  no occupation has a value.
[[nodiscard]] OccupationRows average_occupations(const SurveySource& source,
                                                 const SurveyStays& stays,
                                                 const Progress& progress);

}  // namespace a351::corrector
