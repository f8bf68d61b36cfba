#include "corrector/adjustment/prior.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::adjustment {
namespace {

std::string allowed_range(std::string_view name) {
    if (name.starts_with(kScale))
        return fmt::format("mean from {} to {}, sd from {} to {}",
                           text::shortest(1.0 - kGreatestScaleError),
                           text::shortest(1.0 + kGreatestScaleError), text::shortest(kLeastPriorSd),
                           text::shortest(kGreatestScaleError));
    return fmt::format("mean from -{0} to {0}, sd from {1} to {0}", text::shortest(kGreatestPrior),
                       text::shortest(kLeastPriorSd));
}

bool is_in_range(std::string_view name, const Prior& prior) {
    const bool is_scale = name.starts_with(kScale);
    const double most = is_scale ? kGreatestScaleError : kGreatestPrior;
    return std::abs(prior.mean - (is_scale ? 1.0 : 0.0)) <= most && prior.sd >= kLeastPriorSd &&
           prior.sd <= most;
}

std::vector<std::string> prior_names() {
    std::vector<std::string> names;
    for (const Term* const term : terms_with_prior()) names.emplace_back(term->name);
    return names;
}

bool may_have_prior(std::string_view name) {
    const std::string of_one = scale_name("");
    if (name.starts_with(of_one) && name.size() > of_one.size()) return true;
    return std::ranges::find(terms_with_prior(), name, &Term::name) != terms_with_prior().end();
}

}  // namespace

std::string scale_name(std::string_view instrument) {
    return fmt::format("{} {}", kScale, instrument);
}

const Prior* Priors::find(std::string_view name) const {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
}

Prior Priors::in_use(std::string_view name, Prior prior) const {
    if (const auto factor = factors.find(name); factor != factors.end()) prior.sd *= factor->second;
    return prior;
}

Prior Priors::scale_of(std::string_view instrument) const {
    for (const std::string& name : {scale_name(instrument), std::string(kScale)})
        if (const Prior* const given = find(name)) return *given;
    return instrument.empty() ? kSensorScale : kGravimeterScale;
}

bool Priors::has_slope() const {
    return std::ranges::any_of(values, [](const auto& one) { return !one.first.starts_with(kScale); });
}

std::vector<std::string> unused_priors(const Priors& priors,
                                       const std::vector<std::string>& names) {
    std::vector<std::string> unused;
    for (const auto& [name, prior] : priors.values)
        if (std::ranges::find(names, name) == names.end()) unused.push_back(name);
    return unused;
}

void set_prior(Priors& priors, std::string_view origin, std::string_view name, Prior prior) {
    if (!may_have_prior(name))
        throw InputError(fmt::format("{} = {}: no such coefficient; allowed: {}, scale INSTRUMENT", origin,
                                     name, text::joined(prior_names())));
    if (!is_in_range(name, prior))
        throw InputError(fmt::format("{} = {} {} {}: out of range; allowed: {}", origin, name,
                                     text::shortest(prior.mean), text::shortest(prior.sd),
                                     allowed_range(name)));
    priors.values[std::string(name)] = prior;
}

std::string add_published_priors(Priors& priors) {
    priors.values.try_emplace(std::string(kTemperature.name), Prior{-29.0, 10.0});
    priors.values.try_emplace(std::string(kTime.name), Prior{0.0, 1.0});
    std::vector<std::string> texts;
    for (const std::string& name : prior_names())
        if (const Prior* const prior = priors.find(name))
            texts.push_back(fmt::format("{} {} +- {}", name, text::shortest(prior->mean),
                                        text::shortest(prior->sd)));
    return text::joined(texts);
}

void read_priors(Priors& priors, text::TomlTable table) {
    for (const std::string& name : prior_names()) {
        const auto numbers = table.numbers(name, -kGreatestPrior, kGreatestPrior);
        if (!table.has(name)) continue;
        if (numbers.size() != 2)
            table.refuse(name, fmt::format("{} numbers", numbers.size()), "[mean, sd]");
        const Prior prior{numbers[0], numbers[1]};
        if (!is_in_range(name, prior)) table.refuse(name, "out of range", allowed_range(name));
        priors.values[name] = prior;
    }
    table.require_all_read();
}

}  // namespace a351::corrector::adjustment
