#include "corrector/command/gravity_so_far.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "corrector/design/evening.hpp"
#include "corrector/job/survey_day.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/job/survey_units.hpp"
#include "corrector/reading/refused.hpp"
#include "corrector/report/gravity_so_far.hpp"
#include "protocol/archive/journal_tail.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::corrector::command {

void print_gravity_so_far(job::SurveyFile survey) {
    survey.is_so_far = true;
    report::GravitySoFar so_far;
    so_far.as_of = survey.running_until = archive::journal_end(survey.root / "journal");
    survey = job::by_unit(survey).back();  // the sensor that records now
    try {
        so_far.read = job::read_survey(survey, [](std::size_t, std::size_t) {});
        so_far.as_of = so_far.read->as_of;
        so_far.result = job::correct_survey_day(survey, *so_far.read);
        so_far.u_evening =
            design::u_in_the_evening(*so_far.result, so_far.read->sites, so_far.read->running_key);
    } catch (const reading::Refused& refused) {
        so_far.reason = refused.code();
        so_far.reason_text = report::in_words(refused);
    }
    std::cout << text::json_text(report::to_json(so_far), 2) << '\n';
}

}  // namespace a351::corrector::command
