#include "corrector/result/scale_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {

using Json = nlohmann::ordered_json;

std::vector<std::string> scale_sentences(const model::SurveyCorrection& result) {
    std::vector<std::string> sentences;
    for (const model::ScaleEstimate& scale : result.scales) {
        const model::Interval limits = scale.limits();
        sentences.push_back(text::tr(
            "scale of {}: {} +- {} (95 % limits: {} to {}). Of the variance of its prior ({} +- "
            "{}) the readings leave {} %. The scale makes a difference of 100 mGal uncertain by {} "
            "mGal",
            scale.instrument.empty() ? text::tr("the sensor") : scale.instrument,
            text::fixed(scale.value, 5), text::fixed(scale.u, 5), text::fixed(limits.low, 5),
            text::fixed(limits.high, 5), text::shortest(scale.prior.mean),
            text::shortest(scale.prior.sd), std::lround(100.0 * scale.prior_share()),
            text::fixed(100.0 * scale.u, 3)));
    }
    return sentences;
}

Json scales_json(const std::vector<model::ScaleEstimate>& scales) {
    Json list = Json::array();
    for (const model::ScaleEstimate& scale : scales) {
        const model::Interval limits = scale.limits();
        list.push_back({{"instrument", text::or_null(scale.instrument)},
                        {"value", scale.value},
                        {"u", scale.u},
                        {"limits_95", {limits.low, limits.high}},
                        {"prior", {{"mean", scale.prior.mean}, {"sd", scale.prior.sd}}},
                        {"prior_share", scale.prior_share()}});
    }
    return list;
}

}  // namespace a351::corrector::result
