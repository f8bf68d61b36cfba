#include "corrector/model/trend_comparison.hpp"

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {

std::string trend_comparison_text(const SurveyCorrection& result) {
    double sum = 0.0;
    double squares = 0.0;
    double largest = 0.0;
    std::string where;
    std::size_t count = 0;
    for (const CorrectedRow& row : result.rows) {
        if (!row.row.record) continue;
        const double difference = row.row.record->smoother_minus_eemd().value();
        ++count;
        sum += difference;
        squares += difference * difference;
        if (std::abs(difference) < std::abs(largest)) continue;
        largest = difference;
        where = row.row.site + " (" + std::to_string(row.row.occupation) + ")";
    }
    if (count == 0) return {};
    const double n = static_cast<double>(count);
    return "trends, smoother minus EEMD: mean " + text::fixed(sum / n, 3) + ", rms " +
           text::fixed(std::sqrt(squares / n), 3) + ", largest " + text::fixed(largest, 3) +
           " mGal at " + where + '\n';
}

}  // namespace a351::corrector
