#pragma once

#include "corrector/job/survey_file.hpp"

namespace a351::corrector::command {

/// Prints the gravity so far of a data root that is still being recorded, as one JSON document.
/// Nothing is written to disk.  Readings that cannot be corrected yet are no error: the document has
/// the reason.
/// @throws InputError  a file that the survey names has a mistake.
void print_gravity_so_far(job::SurveyFile survey);

}  // namespace a351::corrector::command
