#include "corrector/job/survey_readings.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {
namespace {

SurveySource source_of(const SurveyFile& survey) {
    SurveySource source;
    source.path = survey.path;
    source.root = survey.root;
    source.sites = survey.sites;
    source.occupations = survey.occupations;
    source.amendments = survey.amendments;
    source.from = survey.from;
    source.to = survey.to;
    source.averaging.norm = survey.norm;
    source.averaging.trend = trend_method_of(survey);
    source.averaging.cutoff_s = survey.cutoff_s;
    source.averaging.curve = trend_curve_of(survey);
    source.averaging.seed = survey.seed;
    return source;
}

/// Adds the other files that a survey file names, in the order of result.json: the survey file
/// first, calibration and tide before the archive.
void add_inputs(std::vector<text::InputFile>& inputs, const SurveyFile& survey) {
    std::vector<text::InputFile> more;
    if (!survey.calibration.empty())
        more.push_back(text::describe_input("calibration", survey.calibration));
    if (!survey.tide.series.empty())
        more.push_back(text::describe_input("tide", survey.tide.series));
    const auto archive =
        std::find_if(inputs.begin(), inputs.end(),
                     [](const text::InputFile& input) { return input.role == "archive"; });
    inputs.insert(archive, more.begin(), more.end());
    if (!survey.path.empty())
        inputs.insert(inputs.begin(), text::describe_input("survey", survey.path));
}

}  // namespace

OccupationRows read_survey(const SurveyFile& survey, const Progress& progress) {
    const SurveySource source = source_of(survey);
    const SurveyStays stays = read_survey_inputs(source);
    std::vector<std::string> warnings;
    if (survey.survey.calibration)
        warnings = check_calibration(survey, stays.station.serial_number, stays.list.windows);
    OccupationRows read = average_occupations(source, stays, progress);
    read.warnings.insert(read.warnings.begin(), warnings.begin(), warnings.end());
    apply_tide(read.rows, read.sites, survey.tide);
    add_inputs(read.inputs, survey);
    return read;
}

SurveyOptions with_sites_of(OccupationRows& read, SurveyOptions options) {
    const auto is_absent = [&read](const std::string& site) {
        return std::none_of(read.rows.begin(), read.rows.end(),
                            [&site](const SurveyRow& row) { return row.site == site; });
    };
    if (!options.base.empty() && is_absent(options.base) && options.model != "paper") {
        read.warnings.push_back("base " + options.base +
                                " has no occupation with a value: the first site is used instead");
        options.base.clear();
    }
    auto& datum = options.datum;
    if (std::all_of(datum.begin(), datum.end(), is_absent)) return options;
    for (const std::string& site : datum) {
        if (!is_absent(site)) continue;
        read.warnings.push_back("datum " + site +
                                " has no occupation with a value: it is left out");
    }
    std::erase_if(datum, is_absent);
    return options;
}

std::vector<std::string> check_calibration(const SurveyFile& survey,
                                           const std::string& serial_number,
                                           const std::vector<OccupationWindow>& windows) {
    const Calibration& calibration = survey.survey.calibration.value();
    std::vector<std::string> warnings;
    if (serial_number.empty()) {
        warnings.push_back(
            "the station metadata do not contain the sensor's serial number: it was not checked "
            "that the calibration of " +
            calibration.serial_number + " belongs to this sensor");
    } else if (serial_number != calibration.serial_number) {
        throw InputError(survey.path.string() + ": calibration = " + survey.calibration.string() +
                         ": of unit " + calibration.serial_number + ", the record is of unit " +
                         serial_number + "; allowed: a calibration of " + serial_number);
    }
    const UtcTime end = calibration.valid_to.value_or(UtcTime::max());
    if (windows.front().start < calibration.valid_from || windows.back().end > end)
        warnings.push_back(
            "the survey is not completely within the validity of the calibration, from " +
            to_rfc3339(calibration.valid_from) +
            (calibration.valid_to ? " to " + to_rfc3339(end) : std::string(" on")));
    return warnings;
}

}  // namespace a351::corrector
