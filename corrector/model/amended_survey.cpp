#include "corrector/model/amended_survey.hpp"

#include <algorithm>

namespace a351::corrector::model {

AmendedSurvey amended(const std::vector<reading::SurveyRow>& rows, const SurveyOptions& options,
                      const std::vector<adjustment::Alternative>& alternatives) {
    using Kind = adjustment::AlternativeKind;
    AmendedSurvey survey{rows, options, {}};
    const auto take_name = [&](const std::vector<std::size_t>& from, std::size_t other) {
        for (const std::size_t i : from) {
            survey.rows[i].site = rows[other].site;
            survey.rows[i].reference = rows[other].reference;
            survey.rows[i].u_reference = rows[other].u_reference;
        }
    };
    for (const adjustment::Alternative& one : alternatives) switch (one.kind) {
            case Kind::set_up:
            case Kind::stay:
                for (const std::size_t i : one.readings) survey.rows[i].is_excluded = true;
                break;
            case Kind::station:
                for (const std::size_t i : one.readings) survey.rows[i].is_reference_refused = true;
                break;
            case Kind::swap:
                take_name(one.readings, one.others.front());
                take_name(one.others, one.readings.front());
                break;
            case Kind::step:
                survey.options.steps.push_back({time_before(rows, one.readings.front()),
                                                rows[one.readings.front()].instrument});
                break;
        }
    std::ranges::sort(survey.options.steps, {}, &adjustment::Step::time);
    survey.choice = choose_rows(survey.rows, survey.options.datum, options.use_flags);
    return survey;
}

std::size_t reading_before(const std::vector<reading::SurveyRow>& rows, std::size_t after) {
    std::size_t before = after;
    while (before > 0)
        if (rows[--before].instrument == rows[after].instrument) break;
    return before;
}

UtcTime time_before(const std::vector<reading::SurveyRow>& rows, std::size_t after) {
    const reading::SurveyRow& before = rows[reading_before(rows, after)];
    const UtcTime end = before.last_instant(), start = rows[after].first_instant();
    return end + (start - end) / 2;
}

}  // namespace a351::corrector::model
