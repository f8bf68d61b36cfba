#include "corrector/reading/amendments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::reading {
namespace {

using Windows = std::vector<OccupationWindow>;

std::string required_string(text::TomlTable& table, std::string_view key,
                            std::string_view allowed) {
    std::string value = table.string_or(key, "");
    if (value.empty()) table.refuse(key, "missing", allowed);
    return value;
}

int required_count(text::TomlTable& table, std::string_view key) {
    if (!table.has(key)) table.refuse(key, "missing", "1, 2, ...");
    return static_cast<int>(table.integer_or(key, 1, 1, std::numeric_limits<int>::max()));
}

std::string list_of(const Windows& windows, std::string (*name)(const OccupationWindow&)) {
    std::set<std::string> names;
    for (const OccupationWindow& window : windows) names.insert(name(window));
    return text::joined({names.begin(), names.end()});
}

/// Carries out single amendments on the list of occupations.
class Amender {
public:
    Amender(Windows& windows, const std::vector<text::Site>& sites)
        : before_(windows), windows_(windows), sites_(sites), changed_(windows.size()) {}

    Amendment mark(text::TomlTable& table, const std::string& kind) {
        Amendment amendment = read(table, kind);
        for (const std::size_t i : matching(table, amendment, "use")) {
            if (kind == "exclude") windows_[i].is_excluded = true;
            if (kind == "include") windows_[i].is_flagged = false;
            windows_[i].notes.push_back(kind + "d");
        }
        return amendment;
    }

    Amendment retime(text::TomlTable& table) {
        Amendment amendment = read(table, "retime");
        const auto start = table.instant("start_utc");
        const auto end = table.instant("end_utc");
        if (!start && !end) table.refuse("start_utc", "missing", "start_utc, end_utc or both");
        const auto matches = matching(table, amendment, "times");
        if (matches.size() > 1) {
            table.refuse("set_up", "missing",
                         fmt::format("1 to {}, the set-up to be re-timed", matches.size()));
        }
        OccupationWindow& window = windows_[matches.front()];
        window.start = start.value_or(window.start);
        window.end = end.value_or(window.end);
        if (window.end <= window.start) {
            table.refuse(end ? "end_utc" : "start_utc", "the end is not after the start",
                         "a start before " + to_rfc3339(window.end));
        }
        window.notes.emplace_back("retimed");
        amendment.change =
            fmt::format("to {} - {}", to_rfc3339(window.start), to_rfc3339(window.end));
        return amendment;
    }

    Amendment rename(text::TomlTable& table) {
        Amendment amendment = read(table, "rename");
        const std::string to = required_string(table, "to", "the name of the site");
        if (text::find_site(sites_, to) == nullptr) {
            std::vector<std::string> names;
            for (const text::Site& site : sites_) names.push_back(site.name);
            table.refuse("to", "no such site", text::joined(names));
        }
        if (to == amendment.site) table.refuse("to", "already its name", "another site");
        const auto matches = matching(table, amendment, "name");
        const int number = free_number(to, amendment.occupation);
        for (const std::size_t i : matches) {
            windows_[i].site = to;
            windows_[i].number = number;
            windows_[i].notes.emplace_back("renamed");
        }
        amendment.change = fmt::format("to {} ({})", to, number);
        return amendment;
    }

private:
    static Amendment read(text::TomlTable& table, const std::string& kind) {
        Amendment amendment;
        amendment.kind = kind;
        amendment.site = required_string(table, "site", "the site of an occupation");
        amendment.occupation = required_count(table, "occupation");
        if (kind != "rename" && table.has("set_up"))
            amendment.set_up = required_count(table, "set_up");
        amendment.reason = required_string(table, "reason", "the reason, in words");
        return amendment;
    }

    /// Returns the indices of the windows that an amendment names.
    /// @param what  the property to change; a second change of it is a contradiction.
    std::vector<std::size_t> matching(text::TomlTable& table, const Amendment& amendment,
                                      const std::string& what) {
        table.require_all_read();
        std::vector<std::size_t> stay;
        Windows of_site;
        for (std::size_t i = 0; i < before_.size(); ++i) {
            if (before_[i].site != amendment.site) continue;
            of_site.push_back(before_[i]);
            if (before_[i].number == amendment.occupation) stay.push_back(i);
        }
        if (of_site.empty()) {
            table.refuse(
                "site", "no occupation there",
                list_of(before_, [](const OccupationWindow& window) { return window.site; }));
        }
        if (stay.empty()) {
            table.refuse("occupation", "no such occupation of " + amendment.site,
                         list_of(of_site, [](const OccupationWindow& window) {
                             return std::to_string(window.number);
                         }));
        }
        if (amendment.set_up) {
            const auto at = static_cast<std::size_t>(*amendment.set_up - 1);
            if (at >= stay.size()) {
                table.refuse("set_up", "no such set-up", fmt::format("1 to {}", stay.size()));
            }
            stay = {stay[at]};
        }
        for (const std::size_t i : stay) {
            if (changed_[i].insert(what).second) continue;
            table.refuse("occupation", "contradicts another amendment of its " + what, "one");
        }
        return stay;
    }

    [[nodiscard]] int free_number(const std::string& site, int wanted) const {
        int largest = 0;
        bool is_taken = false;
        for (const Windows* const list : {&before_, &std::as_const(windows_)}) {
            for (const OccupationWindow& window : *list) {
                if (window.site != site) continue;
                largest = std::max(largest, window.number);
                is_taken = is_taken || window.number == wanted;
            }
        }
        return is_taken ? largest + 1 : wanted;
    }

    const Windows before_;
    Windows& windows_;
    const std::vector<text::Site>& sites_;
    std::vector<std::set<std::string>> changed_;  ///< Changed properties of each window.
};

}  // namespace

std::vector<Amendment> amend(Windows& windows, const std::filesystem::path& file,
                             const std::vector<text::Site>& sites) {
    text::TomlTable document = text::read_toml(file);
    Amender amender(windows, sites);
    std::vector<Amendment> amendments;
    for (const std::string kind : {"exclude", "include"}) {
        for (text::TomlTable& table : document.tables(kind))
            amendments.push_back(amender.mark(table, kind));
    }
    for (text::TomlTable& table : document.tables("retime"))
        amendments.push_back(amender.retime(table));
    for (text::TomlTable& table : document.tables("rename"))
        amendments.push_back(amender.rename(table));
    document.require_all_read();
    return amendments;
}

std::string amendments_text(const std::vector<Amendment>& amendments) {
    std::string text;
    for (const Amendment& amendment : amendments) {
        text += fmt::format("amended: {} {} ({})", amendment.kind, amendment.site,
                            amendment.occupation);
        if (amendment.set_up) text += fmt::format(", set-up {}", *amendment.set_up);
        if (!amendment.change.empty()) text += ' ' + amendment.change;
        text += ": " + amendment.reason + '\n';
    }
    return text;
}

nlohmann::ordered_json amendments_json(const std::vector<Amendment>& amendments) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Amendment& amendment : amendments) {
        nlohmann::ordered_json& json = list.emplace_back();
        json["kind"] = amendment.kind;
        json["site"] = amendment.site;
        json["occupation"] = amendment.occupation;
        json["set_up"] = nullptr;
        if (amendment.set_up) json["set_up"] = *amendment.set_up;
        json["change"] = amendment.change;
        json["reason"] = amendment.reason;
    }
    return list;
}

}  // namespace a351::corrector::reading
