#include "daemon/identify/fitting_profile.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "protocol/core/input_error.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/wire/profile_reader.hpp"
#include "protocol/wire/shipped_profiles.hpp"

namespace a351::daemon::identify {
namespace {

constexpr std::string_view kSource = R"("assumed: it fits what a351d --identify saw")";

/// A profile's text, in which the value of a key can be replaced.
class ProfileText {
public:
    explicit ProfileText(const std::string& toml) : toml_(toml) {}

    /// Replaces the lines KEY = ... of a table; "" is the top of the file.
    void set(std::string_view table, std::string_view key, std::string_view value) {
        std::istringstream lines(toml_);
        std::string changed, now;
        for (std::string line; std::getline(lines, line); changed += line + "\n") {
            if (line.starts_with('[')) now = line.substr(1, line.find(']') - 1);
            if (now == table && line.starts_with(fmt::format("{} =", key)))
                line = fmt::format("{} = {}", key, value);
        }
        toml_ = std::move(changed);
    }
    [[nodiscard]] const std::string& toml() const { return toml_; }

private:
    std::string toml_;
};

std::string text_of(const wire::DeviceProfile& profile) {
    const auto shipped =
        std::ranges::find(wire::shipped_profiles(), profile.name, &wire::ShippedProfile::name);
    return shipped == wire::shipped_profiles().end() ? profile.toml : std::string(shipped->toml);
}

/// Returns true if a text is a profile with these changes.
bool has_changes(const std::string& toml, const Changes& changes) {
    try {
        const auto profile = wire::parse_profile(toml, "fitting", "fitting.toml");
        const auto& temperature = changes.temperature;
        return (changes.product_id.empty() || profile.product_id == changes.product_id) &&
               profile.acceleration_fraction_bits == changes.acceleration_fraction_bits.value_or(
                                                         profile.acceleration_fraction_bits) &&
               (!temperature || (profile.temperature_slope_degc == temperature->slope_degc &&
                                 profile.temperature_offset_degc == temperature->offset_degc));
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

const wire::DeviceProfile* shipped_profile_of(const std::string& product_id) {
    for (const std::string& name : wire::profile_names()) {
        const auto* const profile = wire::find_profile(name);
        if (product_id.starts_with(profile->product_id_prefix)) return profile;
    }
    return nullptr;
}

std::vector<std::string> sources_of(const wire::DeviceProfile& profile) {
    text::TomlTable document = text::parse_toml(text_of(profile), profile.name);
    std::vector<std::string> sources{"device: " + document.string_or("source", "")};
    for (const char* name :
         {"acceleration", "tilt", "temperature", "timing", "output_rate", "baud", "filter"})
        sources.push_back(
            fmt::format("{}: {}", name, document.table(name).string_or("source", "")));
    return sources;
}

std::optional<std::string> fitting_profile(const wire::DeviceProfile& base,
                                           const Changes& changes) {
    ProfileText text(text_of(base));
    text.set("", "verified", "false");
    if (!changes.product_id.empty()) {
        text.set("", "prefix", fmt::format("\"{}\"", changes.product_id));
        text.set("", "product_id", fmt::format("\"{}\"", changes.product_id));
        text.set("", "source", kSource);
    }
    if (changes.acceleration_fraction_bits) {
        text.set("acceleration", "fraction_bits",
                 fmt::format("{}", *changes.acceleration_fraction_bits));
        text.set("acceleration", "source", kSource);
    }
    if (const auto& temperature = changes.temperature) {
        text.set("temperature", "slope_degc", fmt::format("{}", temperature->slope_degc));
        text.set("temperature", "offset_degc", fmt::format("{}", temperature->offset_degc));
        text.set("temperature", "width_bits", "32");
        text.set("temperature", "source", kSource);
    }
    if (!has_changes(text.toml(), changes)) return std::nullopt;
    return text.toml();
}

}  // namespace a351::daemon::identify
