#include "corrector/model/prior.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector {
namespace {

std::string allowed_range() {
    return "mean from -" + text::shortest(kGreatestPrior) + " to " +
           text::shortest(kGreatestPrior) + ", sd from " + text::shortest(kLeastPriorSd) + " to " +
           text::shortest(kGreatestPrior);
}

bool is_in_range(const Prior& prior) {
    return std::abs(prior.mean) <= kGreatestPrior && prior.sd >= kLeastPriorSd &&
           prior.sd <= kGreatestPrior;
}

}  // namespace

const Prior* ModelPriors::find(std::string_view name) const {
    const auto* const at = std::find(kPriorNames.begin(), kPriorNames.end(), name);
    if (at == kPriorNames.end()) return nullptr;
    const auto& value = values[static_cast<std::size_t>(at - kPriorNames.begin())];
    return value ? &*value : nullptr;
}

bool has_any(const ModelPriors& priors) {
    return std::any_of(priors.values.begin(), priors.values.end(),
                       [](const auto& value) { return value.has_value(); });
}

void set_prior(ModelPriors& priors, std::string_view origin, std::string_view name, Prior prior) {
    const auto* const at = std::find(kPriorNames.begin(), kPriorNames.end(), name);
    const std::string start = std::string(origin) + " = " + std::string(name);
    if (at == kPriorNames.end()) {
        std::string names;
        for (const std::string_view known : kPriorNames) {
            names += (names.empty() ? "" : ", ") + std::string(known);
        }
        throw InputError(start + ": no such coefficient; allowed: " + names);
    }
    if (!is_in_range(prior)) {
        throw InputError(start + ' ' + text::shortest(prior.mean) + ' ' + text::shortest(prior.sd) +
                         ": out of range; allowed: " + allowed_range());
    }
    priors.values[static_cast<std::size_t>(at - kPriorNames.begin())] = prior;
}

void read_priors(ModelPriors& priors, text::TomlTable table) {
    for (std::size_t k = 0; k < kPriorNames.size(); ++k) {
        const auto numbers = table.numbers(kPriorNames[k], -kGreatestPrior, kGreatestPrior);
        if (!table.has(kPriorNames[k])) continue;
        if (numbers.size() != 2) {
            table.refuse(kPriorNames[k], std::to_string(numbers.size()) + " numbers", "[mean, sd]");
        }
        const Prior prior{numbers[0], numbers[1]};
        if (!is_in_range(prior)) table.refuse(kPriorNames[k], "out of range", allowed_range());
        priors.values[k] = prior;
    }
    table.require_all_read();
}

}  // namespace a351::corrector
