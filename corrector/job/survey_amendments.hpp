#pragma once
/// @file
/// Proposals of the findings, written to the amendments file of a survey.
///
///     const SurveyFile survey = read_survey_file("day.toml");
///     add_amendments(survey, findings, {});   // day-amendments.toml, named in day.toml

#include <filesystem>
#include <string>
#include <vector>

#include "corrector/job/survey_file.hpp"
#include "corrector/reading/finding.hpp"

namespace a351::corrector::job {

/// Returns the text of a survey file with its key `amendments` set; everything else stays.
/// @param text  with a line [survey].
[[nodiscard]] std::string with_amendments_key(const std::string& text, const std::string& value);

/// Appends the amendments of findings to the amendments file, each with its sentence as comment, and
/// names the file in the survey file.
///
/// Before any file is changed, the new amendments are carried out on the survey's occupations, so that
/// one that is refused changes nothing.  A new file has the survey's earlier amendments too.
/// @param findings  those with an amendment.
/// @param file      amendments file; empty: the one of the survey, or else NAME-amendments.toml beside
///                  the survey file NAME.toml.
/// @return the amendments file.
/// @throws InputError  an amendment is refused, the survey file has no line [survey], or the file
///                     exists and is not that of the survey.
std::filesystem::path add_amendments(const SurveyFile& survey,
                                     const std::vector<reading::Finding>& findings,
                                     std::filesystem::path file);

}  // namespace a351::corrector::job
