#include "corrector/result/scale_report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::result {

using Json = nlohmann::ordered_json;

std::vector<std::string> scale_sentences(const model::SurveyCorrection& result) {
    std::vector<std::string> sentences;
    for (const model::ScaleEstimate& scale : result.scales) {
        const model::Interval limits = scale.limits();
        sentences.push_back(fmt::format(
            "scale of {}: {} +- {} (95 % limits {} to {}); it is {} % prior ({} +- {}), and makes "
            "a "
            "difference of 100 mGal uncertain by {} mGal",
            scale.instrument.empty() ? "the sensor" : scale.instrument, text::fixed(scale.value, 5),
            text::fixed(scale.u, 5), text::fixed(limits.low, 5), text::fixed(limits.high, 5),
            std::lround(100.0 * scale.prior_share()), text::shortest(scale.prior.mean),
            text::shortest(scale.prior.sd), text::fixed(100.0 * scale.u, 3)));
    }
    return sentences;
}

Json scales_json(const std::vector<model::ScaleEstimate>& scales) {
    Json list = Json::array();
    for (const model::ScaleEstimate& scale : scales) {
        const model::Interval limits = scale.limits();
        list.push_back(
            {{"instrument", scale.instrument.empty() ? Json(nullptr) : Json(scale.instrument)},
             {"value", scale.value},
             {"u", scale.u},
             {"limits_95", {limits.low, limits.high}},
             {"prior", {{"mean", scale.prior.mean}, {"sd", scale.prior.sd}}},
             {"prior_share", scale.prior_share()}});
    }
    return list;
}

}  // namespace a351::corrector::result
