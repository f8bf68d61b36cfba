#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/text/sites.hpp"

namespace a351::daemon::ctl {

/// The names of the benchmarks, for an operator who types one.
class SiteNames {
public:
    SiteNames() = default;
    /// @param answer  of GET /api/sites: nearest first.
    explicit SiteNames(const nlohmann::json& answer);

    [[nodiscard]] bool empty() const noexcept { return sites_.empty(); }

    /// Returns the first eight names that begin with this text, separated by commas.
    [[nodiscard]] std::string beginning_with(std::string_view text) const;

    /// Returns the text, completed as far as the names that begin with it agree; std::nullopt if there
    /// are none.
    [[nodiscard]] std::optional<std::string> completed(std::string_view text) const;

    /// Returns the name that was meant by one that is not in the list, see text::similar_site().
    [[nodiscard]] std::optional<std::string> meant_by(std::string_view text) const;

private:
    std::vector<text::Site> sites_;  ///< Names alone.
};

}  // namespace a351::daemon::ctl
