#include "corrector/model/prior.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::model {
namespace {

std::string allowed_range(std::string_view name) {
    if (name == kScale)
        return fmt::format("mean from {} to {}, sd from {} to {}",
                           text::shortest(1.0 - kGreatestScaleError),
                           text::shortest(1.0 + kGreatestScaleError), text::shortest(kLeastPriorSd),
                           text::shortest(kGreatestScaleError));
    return fmt::format("mean from -{0} to {0}, sd from {1} to {0}", text::shortest(kGreatestPrior),
                       text::shortest(kLeastPriorSd));
}

bool is_in_range(std::string_view name, const Prior& prior) {
    const bool is_scale = name == kScale;
    const double most = is_scale ? kGreatestScaleError : kGreatestPrior;
    return std::abs(prior.mean - (is_scale ? 1.0 : 0.0)) <= most && prior.sd >= kLeastPriorSd &&
           prior.sd <= most;
}

}  // namespace

const Prior* Priors::find(std::string_view name) const {
    const auto* const at = std::find(kPriorNames.begin(), kPriorNames.end(), name);
    if (at == kPriorNames.end()) return nullptr;
    const auto& value = values[static_cast<std::size_t>(at - kPriorNames.begin())];
    return value ? &*value : nullptr;
}

Prior Priors::in_use(std::string_view name, Prior prior) const {
    if (const auto factor = factors.find(name); factor != factors.end()) prior.sd *= factor->second;
    return prior;
}

Prior Priors::scale_of(std::string_view instrument) const {
    if (const Prior* const given = find(kScale)) return *given;
    return instrument.empty() ? kSensorScale : kGravimeterScale;
}

bool Priors::has_slope() const {
    return std::ranges::any_of(kPriorNames, [this](std::string_view name) {
        return name != kScale && find(name) != nullptr;
    });
}

void set_prior(Priors& priors, std::string_view origin, std::string_view name, Prior prior) {
    const auto* const at = std::find(kPriorNames.begin(), kPriorNames.end(), name);
    if (at == kPriorNames.end())
        throw InputError(fmt::format(
            "{} = {}: no such coefficient; allowed: {}", origin, name,
            text::joined(std::vector<std::string>(kPriorNames.begin(), kPriorNames.end()))));
    if (!is_in_range(name, prior))
        throw InputError(fmt::format("{} = {} {} {}: out of range; allowed: {}", origin, name,
                                     text::shortest(prior.mean), text::shortest(prior.sd),
                                     allowed_range(name)));
    priors.values[static_cast<std::size_t>(at - kPriorNames.begin())] = prior;
}

std::string add_published_priors(Priors& priors) {
    // In the order of kPriorNames: temperature, its rate, time, scale.
    constexpr std::array<std::optional<Prior>, kPriorNames.size()> kPublished{
        Prior{-29.0, 10.0}, std::nullopt, Prior{0.0, 1.0}, std::nullopt};
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < kPriorNames.size(); ++k) {
        std::optional<Prior>& prior = priors.values[k];
        if (!prior) prior = kPublished[k];
        if (prior)
            texts.push_back(fmt::format("{} {} +- {}", kPriorNames[k], text::shortest(prior->mean),
                                        text::shortest(prior->sd)));
    }
    return text::joined(texts);
}

void read_priors(Priors& priors, text::TomlTable table) {
    for (std::size_t k = 0; k < kPriorNames.size(); ++k) {
        const auto numbers = table.numbers(kPriorNames[k], -kGreatestPrior, kGreatestPrior);
        if (!table.has(kPriorNames[k])) continue;
        if (numbers.size() != 2)
            table.refuse(kPriorNames[k], fmt::format("{} numbers", numbers.size()), "[mean, sd]");
        const Prior prior{numbers[0], numbers[1]};
        if (!is_in_range(kPriorNames[k], prior))
            table.refuse(kPriorNames[k], "out of range", allowed_range(kPriorNames[k]));
        priors.values[k] = prior;
    }
    table.require_all_read();
}

}  // namespace a351::corrector::model
