#include "corrector/figure/row_marks.hpp"

#include <fmt/core.h>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/figure.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {

const std::vector<Mark>& marks() {
    static const std::vector<Mark> all{
        {text::marked("in the fit"),
         [](const model::CorrectedRow& row) { return row.is_used && !row.row.is_flagged; },
         "pt 7 ps 0.6 lc rgb " + kBlue},
        {text::marked("marked by the operator, in the fit"),
         [](const model::CorrectedRow& row) { return row.is_used && row.row.is_flagged; },
         "pt 6 ps 0.7 lw 1.5 lc rgb " + kBlue},
        {text::marked("left out of the fit"),
         [](const model::CorrectedRow& row) { return !row.is_used; },
         "pt 2 ps 0.7 lw 1.5 lc rgb " + kVermilion},
    };
    return all;
}

std::string comment(const model::SurveyCorrection& result, std::size_t row) {
    return fmt::format("# {}\n", clean_utf8(judgement::reading_name(result.rows, row)));
}

}  // namespace a351::corrector::figure
