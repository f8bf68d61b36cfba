#include "corrector/result/joint_report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/result/columns.hpp"
#include "corrector/result/result_files.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/json_text.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {
namespace {

using Json = nlohmann::ordered_json;

Json terms_json(const std::vector<model::JointTerms>& all, bool are_surveys) {
    Json list = Json::array();
    for (const model::JointTerms& terms : all) {
        Json one;
        if (are_surveys) {
            one["name"] = terms.name;
            one["model"] = terms.model;
        }
        one["serial_number"] = text::or_null(terms.serial_number);
        one["coefficients"] = coefficients_json(terms.coefficients);
        list.push_back(std::move(one));
    }
    return list;
}

Json share_json(const std::optional<whole_day::PlacementShare>& share) {
    if (!share) return nullptr;
    return {{"most_likely", share->most_likely},
            {"expected", share->expected},
            {"limits_95", {share->lowest, share->highest}}};
}

long percent(double share) { return std::lround(100.0 * share); }

}  // namespace

std::string joint_json(const JointResult& joint, const JointTables& tables) {
    const auto* const adjustment = std::get_if<model::JointAdjustment>(&joint);
    Json json;
    json["program"] = "a351-correct";
    json["version"] = A351_VERSION;
    json["method"] = adjustment != nullptr ? "adjustment" : "none";
    for (const char* const key :
         {"reason", "units", "surveys", "placement_share", "uncertainty_factor"})
        json[key] = nullptr;
    std::optional<model::StationCovariance> covariance;
    if (adjustment != nullptr) {
        json["units"] = terms_json(adjustment->units, false);
        json["surveys"] = terms_json(adjustment->surveys, true);
        json["placement_share"] = share_json(adjustment->share);
        json["uncertainty_factor"] = adjustment->uncertainty_factor;
        covariance = adjustment->covariance;
    } else {
        json["reason"] = std::get<text::Message>(joint).english();
    }
    json["stations"] = json_array(joint_columns(), tables.stations);
    json["differences"] = json_array(difference_columns(), tables.differences);
    json["station_covariance"] = covariance_json(covariance);
    return text::json_text(json, 2) + '\n';
}

std::vector<std::string> joint_sentences(const JointResult& joint) {
    const auto* const adjustment = std::get_if<model::JointAdjustment>(&joint);
    if (adjustment == nullptr)
        return {
            text::tr("There is no joint adjustment, because {}. The values of the surveys are "
                     "side by side.",
                     std::get<text::Message>(joint))};
    std::vector<std::string> sentences{
        text::tr("The values are from one adjustment of {} surveys.", adjustment->surveys.size())};
    std::vector<std::string> white;
    for (const model::JointTerms& survey : adjustment->surveys)
        if (survey.coefficients.empty())
            white.push_back(fmt::format("{} ({})", survey.name, survey.model));
    if (!white.empty())
        sentences.push_back(
            text::tr("Corrected by another model than day: {}. They take part with white noise and "
                     "with terms of their own.",
                     text::joined(white)));
    if (adjustment->share)
        sentences.push_back(text::tr(
            "The sensors of a box have {} % of the variance of the placement in common (95 % "
            "limits: {} and {} %).",
            percent(adjustment->share->most_likely), percent(adjustment->share->lowest),
            percent(adjustment->share->highest)));
    if (adjustment->uncertainty_factor > 1.0)
        sentences.push_back(text::tr(
            "The model does not fit one of the surveys: all uncertainties are enlarged by {}.",
            text::fixed(adjustment->uncertainty_factor, 2)));
    return sentences;
}

}  // namespace a351::corrector::result
