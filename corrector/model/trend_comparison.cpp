#include "corrector/model/trend_comparison.hpp"

#include <fmt/core.h>

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {

std::string trend_comparison_text(const SurveyCorrection& result) {
    double sum = 0.0, squares = 0.0, largest = 0.0, count = 0.0;
    std::string where;
    for (const CorrectedRow& row : result.rows) {
        if (!row.row.record) continue;
        const double difference = row.row.record->smoother_minus_eemd().value();
        count += 1.0;
        sum += difference;
        squares += difference * difference;
        if (std::abs(difference) < std::abs(largest)) continue;
        largest = difference;
        where = reading::stay_name(row.row.site, row.row.occupation);
    }
    if (count == 0.0) return {};
    return fmt::format("trends, smoother minus EEMD: mean {}, rms {}, largest {} mGal at {}\n",
                       text::fixed(sum / count, 3), text::fixed(std::sqrt(squares / count), 3),
                       text::fixed(largest, 3), where);
}

}  // namespace a351::corrector::model
