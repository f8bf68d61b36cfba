#include "corrector/result/scale_report.hpp"

#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {

using Json = nlohmann::ordered_json;

namespace {

/// Says how much the readings know of a scale.
std::string source_of(const model::ScaleEstimate& scale) {
    constexpr double kNearlyAll = 0.8, kLittle = 0.2;  // shares of the prior's variance
    const double share = scale.prior_share();
    return share > kNearlyAll ? text::tr("the readings say almost nothing about it")
           : share > kLittle  ? text::tr("the readings confirm its prior and narrow it")
                              : text::tr("it comes from the readings");
}

}  // namespace

std::vector<std::string> scale_sentences(const model::SurveyCorrection& result) {
    std::vector<std::string> sentences;
    for (const model::ScaleEstimate& scale : result.scales) {
        const model::Interval limits = scale.limits();
        const int decimals = text::decimals_for(scale.u);
        const auto shown = [decimals](double value) { return text::fixed(value, decimals); };
        const auto shown_prior = [&scale](double value) {
            return text::fixed(value, text::decimals_for(scale.prior.sd));
        };
        sentences.push_back(
            text::tr("scale of {}: {} +- {} (95 % limits: {} to {}); {} (prior {} +- {}). A "
                     "difference of 100 "
                     "mGal is uncertain by {} mGal because of it",
                     scale.instrument.empty() ? text::tr("the sensor") : scale.instrument,
                     shown(scale.value), shown(scale.u), shown(limits.low), shown(limits.high),
                     source_of(scale), shown_prior(scale.prior.mean), shown_prior(scale.prior.sd),
                     text::fixed(100.0 * scale.u, text::decimals_for(100.0 * scale.u))));
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
