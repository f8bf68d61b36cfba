#pragma once
/// @file
/// What is known of the instrument before the survey: priors on coefficients of the linear models
/// and of the network.  Each is one more row of the least-squares system,
///
///     reading_sd / sd * b = reading_sd / sd * mean,     readings with weight 1.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/text/strict_toml.hpp"

namespace a351::corrector {

struct Prior {
    double mean = 0.0;
    double sd = 1.0;  ///< kLeastPriorSd or more.
};

/// Smaller ones would swamp the readings' digits in the least-squares system.
inline constexpr double kLeastPriorSd = 1e-6;
/// Of mean and sd; any coefficient of this sensor is far below.
inline constexpr double kGreatestPrior = 1e6;

inline constexpr std::array<std::string_view, 3> kPriorNames{
    "temperature_mgal_per_degc", "rate_mgal_per_degc_per_h", "time_mgal_per_h"};

/// Of standard deviations of readings and references: from the resolution of the tables to a
/// scatter that makes them worthless.
inline constexpr double kLeastSd_mgal = 0.001;
inline constexpr double kGreatestSd_mgal = 1000.0;

struct ModelPriors {
    std::array<std::optional<Prior>, kPriorNames.size()> values;  ///< As kPriorNames.

    /// Standard deviation of a reading, which sets its weight against priors and datum.  Default:
    /// the scatter of the published survey about its known stations.
    double reading_sd_mgal = 2.0;

    /// Null when there is none, or no such coefficient.
    [[nodiscard]] const Prior* find(std::string_view name) const;
};

[[nodiscard]] bool has_any(const ModelPriors& priors);

/// Sets one by name.
/// @throws InputError  unknown name, number out of range; `origin` names the option.
void set_prior(ModelPriors& priors, std::string_view origin, std::string_view name, Prior prior);

/// Reads `name = [mean, sd]` for each of kPriorNames.
/// @throws InputError  another key, not two numbers, a number out of range.
void read_priors(ModelPriors& priors, text::TomlTable table);

}  // namespace a351::corrector
