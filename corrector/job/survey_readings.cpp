#include "corrector/job/survey_readings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "corrector/model/model.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector::job {
namespace {

/// Adds the other files that a survey file names, in the order of result.json: the survey file
/// first, calibration and tide before the archive.
/// @param first, last  times of the first and the last reading.
void add_inputs(std::vector<text::InputFile>& inputs, const SurveyFile& survey, UtcTime first,
                UtcTime last) {
    std::vector<text::InputFile> more;
    if (!survey.calibration.empty())
        more.push_back(text::describe_input("calibration", survey.calibration));
    if (!survey.tide.series.empty())
        more.push_back(text::describe_input("tide", survey.tide.series));
    if (!survey.reduction.pressure.empty())
        more.push_back(text::describe_input("pressure", survey.reduction.pressure));
    if (const auto& channel = survey.reduction.pressure_channel)
        for (const std::filesystem::path& file : channel->files(
                 first - reduction::kLongestPressureStep, last + reduction::kLongestPressureStep))
            more.push_back(text::describe_input("pressure", file));
    if (survey.reference)
        more.push_back(text::describe_input("reference", survey.reference->observations));
    const auto archive =
        std::ranges::find(inputs, std::string_view("archive"), &text::InputFile::role);
    inputs.insert(archive, more.begin(), more.end());
    if (!survey.path.empty())
        inputs.insert(inputs.begin(), text::describe_input("survey", survey.path));
}

}  // namespace

reading::OccupationRows read_survey(const SurveyFile& survey,
                                    const archive_series::Progress& progress) {
    reading::SurveySource source = survey;
    source.averaging = averaging_of(survey);
    const reading::SurveyStays stays = reading::read_survey_inputs(source);
    std::vector<text::Message> warnings;
    if (!survey.unused_calibration.empty())
        warnings.push_back(text::message(
            "the calibration is of the sensor {}: it is not used for the readings of {}",
            survey.unused_calibration, survey.unit));
    if (survey.survey.calibration)
        warnings = check_calibration(survey, stays.epoch.serial_number, stays.list.windows);
    reading::OccupationRows read = reading::average_occupations(source, stays, progress);
    read.warnings.insert(read.warnings.begin(), warnings.begin(), warnings.end());
    tide::apply_tide(read.rows, read.sites, survey.tide, read.day ? &*read.day : nullptr);
    for (text::Message& warning : tide::tide_warnings(read.rows, read.sites, survey.tide))
        read.warnings.push_back(std::move(warning));
    const std::vector<text::Message> reduced =
        reduction::reduce_rows(read.rows, read.sites, reduction::read_gradients(survey.sites),
                               survey.reduction, read.day ? &*read.day : nullptr);
    read.warnings.insert(read.warnings.end(), reduced.begin(), reduced.end());
    add_inputs(read.inputs, survey, read.rows.front().time, read.rows.back().time);
    return read;
}

namespace {

/// Returns the steps of the amendments that divide the readings; a warning says which do not.
std::vector<adjustment::Step> steps_between(reading::OccupationRows& read) {
    std::vector<adjustment::Step> steps;
    std::ptrdiff_t last = 0;  // readings before the last step
    const auto count = std::ranges::count(read.rows, false, &reading::SurveyRow::is_excluded);
    for (const UtcTime step : read.amendments.steps) {
        const auto before = std::ranges::count_if(
            read.rows, [step](const auto& row) { return !row.is_excluded && row.time <= step; });
        if (before > last && before < count) {
            steps.push_back({step});
            last = before;
            continue;
        }
        const std::string at = to_rfc3339(step);
        read.warnings.push_back(
            before == 0 ? text::message("the step at {} is not used: no reading is before it", at)
            : before == count
                ? text::message("the step at {} is not used: no reading is after it", at)
                : text::message(
                      "the step at {} is not used: no reading is between it and the step before",
                      at));
    }
    return steps;
}

}  // namespace

model::SurveyOptions with_sites_of(reading::OccupationRows& read, model::SurveyOptions options) {
    options.steps = steps_between(read);
    const auto is_absent = [&read](const std::string& site) {
        return std::ranges::find(read.rows, site, &reading::SurveyRow::site) == read.rows.end();
    };
    if (!options.base.empty() && is_absent(options.base) && options.model != model::kPaper) {
        read.warnings.push_back(
            text::message("base {} has no occupation with a value: the first site is used instead",
                          options.base));
        options.base.clear();
    }
    auto& datum = options.datum;
    if (std::ranges::all_of(datum, is_absent)) return options;
    for (const std::string& site : datum)
        if (is_absent(site))
            read.warnings.push_back(
                text::message("datum {} has no occupation with a value: it is left out", site));
    std::erase_if(datum, is_absent);
    return options;
}

std::vector<text::Message> check_calibration(
    const SurveyFile& survey, const std::string& serial_number,
    const std::vector<reading::OccupationWindow>& windows) {
    const unit::Calibration& calibration = survey.survey.calibration.value();
    std::vector<text::Message> warnings;
    if (serial_number.empty()) {
        warnings.push_back(
            text::message("the station metadata do not contain the sensor's serial number: it was "
                          "not checked that the calibration of {} belongs to this sensor",
                          calibration.serial_number));
    } else if (serial_number != calibration.serial_number) {
        throw InputError(fmt::format(
            "{}: calibration = {}: of unit {}, the record is of unit {}; allowed: a calibration of "
            "{}",
            survey.path.string(), survey.calibration.string(), calibration.serial_number,
            serial_number, serial_number));
    }
    const UtcTime end = calibration.valid_to.value_or(UtcTime::max());
    if (windows.front().start < calibration.valid_from || windows.back().end > end)
        warnings.push_back(
            calibration.valid_to
                ? text::message("the survey is not completely within the validity of the "
                                "calibration, from {} to {}",
                                to_rfc3339(calibration.valid_from), to_rfc3339(end))
                : text::message("the survey is not completely within the validity of the "
                                "calibration, from {} on",
                                to_rfc3339(calibration.valid_from)));
    return warnings;
}

}  // namespace a351::corrector::job
