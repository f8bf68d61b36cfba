#include "corrector/reading/amendments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/plain_text.hpp"

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
    Amender(Windows& windows, std::vector<text::Site>& sites)
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
        const std::string to =
            text::plain_text(required_string(table, "to", "the name of the site"));
        require_site(table, "to", sites_, to);
        if (to == amendment.site) table.refuse("to", "already its name", "another site");
        const auto matches = matching(table, amendment, "name");
        const int number = free_number(to, *amendment.occupation);
        for (const std::size_t i : matches) {
            windows_[i].site = to;
            windows_[i].occupation = number;
            windows_[i].notes.emplace_back("renamed");
        }
        amendment.change = fmt::format("to {} ({})", to, number);
        return amendment;
    }

    Amendment set_up(text::TomlTable& table) {
        Amendment amendment = read(table, "set_up");
        const UtcTime time = required_instant(table);
        std::string allowed;
        for (const std::size_t i : matching(table, amendment, "")) {
            const OccupationWindow& window = windows_[i];
            if (std::ranges::count(divisions_, std::pair(i, time)) > 0)
                table.refuse("time_utc", "contradicts another amendment", "another instant");
            allowed += fmt::format("{}{} to {}", allowed.empty() ? "between " : " or ",
                                   to_rfc3339(window.start), to_rfc3339(window.end));
            if (time <= window.start || time >= window.end) continue;
            divisions_.emplace_back(i, time);
            amendment.change = "at " + to_rfc3339(time);
        }
        if (amendment.change.empty()) table.refuse("time_utc", "not within the stay", allowed);
        return amendment;
    }

    /// Divides the windows of set_up().  Call it last: the numbers of the windows change.
    void divide() {
        std::ranges::sort(divisions_, std::greater());
        for (const auto& [i, time] : divisions_) {
            windows_[i].notes.emplace_back("divided");
            windows_[i].listed = {};  // no amendment can name a part
            OccupationWindow after = windows_[i];
            after.start = time;
            after.face = {};  // nothing was said of this part
            windows_[i].end = time;
            windows_.insert(windows_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                            std::move(after));
        }
    }

    Amendment reference(text::TomlTable& table, std::vector<std::string>& refused) {
        Amendment amendment{.kind = "reference"};
        amendment.site = text::plain_text(required_string(table, "site", "the name of a site"));
        require_site(table, "site", sites_, amendment.site);
        amendment.reason = required_string(table, "reason", kReason);
        const bool is_used = table.boolean_or("use", true);
        const auto gravity =
            table.number("gravity_mgal", text::kLeastGravity_mgal, text::kGreatestGravity_mgal);
        if (is_used != gravity.has_value())
            table.refuse(gravity ? "use" : "gravity_mgal", gravity ? "contradiction" : "missing",
                         "either gravity_mgal or use = false");
        if (!references_.insert(amendment.site).second)
            table.refuse("site", "contradicts another amendment of its reference", "one");
        table.require_all_read();
        if (gravity) {
            const auto site = std::ranges::find(sites_, amendment.site, &text::Site::name);
            site->gravity = MilliGal(*gravity);
            site->u_gravity.reset();  // that of the former value
            amendment.change = fmt::format("to {} mGal", text::fixed(*gravity, 3));
        } else {
            refused.push_back(amendment.site);
            amendment.change = "not used";
        }
        return amendment;
    }

    static Amendment step(text::TomlTable& table, std::vector<UtcTime>& steps) {
        Amendment amendment{.kind = "step"};
        const UtcTime time = required_instant(table);
        if (std::ranges::count(steps, time) > 0)
            table.refuse("time_utc", "contradicts another amendment", "another instant");
        steps.push_back(time);
        amendment.change = "at " + to_rfc3339(steps.back());
        amendment.reason = required_string(table, "reason", kReason);
        table.require_all_read();
        return amendment;
    }

private:
    static constexpr const char* kReason = "the reason, in words";

    static UtcTime required_instant(text::TomlTable& table) {
        const auto time = table.instant("time_utc");
        if (!time) table.refuse("time_utc", "missing", "an instant");
        return *time;
    }

    static Amendment read(text::TomlTable& table, const std::string& kind) {
        Amendment amendment{.kind = kind};
        amendment.site =
            text::plain_text(required_string(table, "site", "the site of an occupation"));
        amendment.occupation = required_count(table, "occupation");
        if (kind != "rename" && kind != "set_up" && table.has("set_up"))
            amendment.set_up = required_count(table, "set_up");
        amendment.reason = required_string(table, "reason", kReason);
        return amendment;
    }

    /// Returns the indices of the windows that an amendment names.
    /// @param what  the property to change; a second change of it is a contradiction, unless empty.
    std::vector<std::size_t> matching(text::TomlTable& table, const Amendment& amendment,
                                      const std::string& what) {
        table.require_all_read();
        std::vector<std::size_t> stay;
        Windows of_site;
        for (std::size_t i = 0; i < before_.size(); ++i) {
            if (before_[i].site != amendment.site) continue;
            of_site.push_back(before_[i]);
            if (before_[i].occupation == amendment.occupation) stay.push_back(i);
        }
        if (of_site.empty()) {
            table.refuse(
                "site", "no occupation there",
                list_of(before_, [](const OccupationWindow& window) { return window.site; }));
        }
        if (stay.empty()) {
            table.refuse("occupation", "no such occupation of " + amendment.site,
                         list_of(of_site, [](const OccupationWindow& window) {
                             return std::to_string(window.occupation);
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
            if (what.empty() || changed_[i].insert(what).second) continue;
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
                largest = std::max(largest, window.occupation);
                is_taken = is_taken || window.occupation == wanted;
            }
        }
        return is_taken ? largest + 1 : wanted;
    }

    const Windows before_;
    Windows& windows_;
    std::vector<text::Site>& sites_;
    std::vector<std::set<std::string>> changed_;  ///< Changed properties of each window.
    std::set<std::string> references_;            ///< Sites whose reference is amended.
    std::vector<std::pair<std::size_t, UtcTime>> divisions_;  ///< Window and instant.
};

}  // namespace

void require_site(const text::TomlTable& table, std::string_view key,
                  const std::vector<text::Site>& sites, const std::string& name) {
    if (text::find_site(sites, name) != nullptr) return;
    std::vector<std::string> names;
    for (const text::Site& site : sites) names.push_back(site.name);
    table.refuse(key, "no such site", text::joined(names));
}

Amendments amend(Windows& windows, const std::filesystem::path& file,
                 std::vector<text::Site>& sites) {
    text::TomlTable document = text::read_toml(file);
    Amender amender(windows, sites);
    Amendments amendments;
    using Table = text::TomlTable;
    const auto each = [&](const std::string& kind, const auto& carry_out) {
        for (Table& table : document.tables(kind)) amendments.list.push_back(carry_out(table));
    };
    for (const std::string kind : {"exclude", "include"})
        each(kind, [&](Table& table) { return amender.mark(table, kind); });
    each("retime", [&](Table& table) { return amender.retime(table); });
    each("rename", [&](Table& table) { return amender.rename(table); });
    each("set_up", [&](Table& table) { return amender.set_up(table); });
    each("step", [&](Table& table) { return amender.step(table, amendments.steps); });
    each("reference",
         [&](Table& table) { return amender.reference(table, amendments.refused_references); });
    amender.divide();
    std::ranges::sort(amendments.steps);
    document.require_all_read();
    return amendments;
}

std::string amendments_text(const std::vector<Amendment>& amendments) {
    std::string text;
    for (const Amendment& amendment : amendments) {
        text += "amended: " + amendment.kind;
        if (!amendment.site.empty()) text += ' ' + amendment.site;
        if (amendment.occupation) text += fmt::format(" ({})", *amendment.occupation);
        if (amendment.set_up) text += fmt::format(", set-up {}", *amendment.set_up);
        if (!amendment.change.empty()) text += ' ' + amendment.change;
        text += ": " + amendment.reason + '\n';
    }
    return text;
}

nlohmann::ordered_json amendments_json(const std::vector<Amendment>& amendments) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Amendment& amendment : amendments) {
        list.push_back({{"kind", amendment.kind},
                        {"site", text::or_null(amendment.site)},
                        {"occupation", text::or_null(amendment.occupation)},
                        {"set_up", text::or_null(amendment.set_up)},
                        {"change", amendment.change},
                        {"reason", amendment.reason}});
    }
    return list;
}

}  // namespace a351::corrector::reading
