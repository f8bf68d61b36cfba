#include "daemon/ctl/site_names.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace a351::daemon::ctl {

SiteNames::SiteNames(const nlohmann::json& answer) {
    for (const auto& site : answer.value("sites", nlohmann::json::array()))
        sites_.emplace_back().name = site.value("site", "");
}

std::string SiteNames::beginning_with(std::string_view text) const {
    constexpr std::size_t kMost = 8;
    std::string names;
    std::size_t count = 0;
    for (const text::Site& site : sites_) {
        if (!site.name.starts_with(text)) continue;
        if (++count > kMost) return names + ", ...";
        names += (names.empty() ? "" : ", ") + site.name;
    }
    return names;
}

std::optional<std::string> SiteNames::completed(std::string_view text) const {
    std::optional<std::string> common;
    for (const text::Site& site : sites_) {
        if (!site.name.starts_with(text)) continue;
        if (!common) common = site.name;
        auto end = std::ranges::mismatch(site.name, *common).in1;
        // Letters of UTF-8 can agree in their first bytes.
        while (end != site.name.end() && (static_cast<unsigned char>(*end) & 0xC0U) == 0x80) --end;
        common = std::string(site.name.begin(), end);
    }
    return common;
}

std::optional<std::string> SiteNames::meant_by(std::string_view text) const {
    if (text::find_site(sites_, text) != nullptr) return std::nullopt;
    const text::Site* const similar = text::similar_site(sites_, text);
    return similar == nullptr ? std::nullopt : std::optional(similar->name);
}

}  // namespace a351::daemon::ctl
