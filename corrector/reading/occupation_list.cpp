#include "corrector/reading/occupation_list.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

#include "corrector/reading/refused.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::reading {
namespace {

std::string named(const OccupationWindow& window) {
    return fmt::format("{} ({}) at {}", window.site, window.occupation, to_rfc3339(window.start));
}

void sort_by_start(std::vector<OccupationWindow>& windows) {
    std::stable_sort(windows.begin(), windows.end(), [](const auto& a, const auto& b) {
        return std::tie(a.start, a.end, a.site, a.occupation) <
               std::tie(b.start, b.end, b.site, b.occupation);
    });
}

bool do_overlap(const OccupationWindow& a, const OccupationWindow& b) {
    return a.start < b.end && b.start < a.end;
}

/// Returns the indices of the windows that overlap the largest number of others; none if no windows
/// overlap.
std::vector<std::size_t> most_overlapping(const std::vector<OccupationWindow>& windows) {
    std::vector<std::size_t> most;
    std::size_t largest = 1;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        std::size_t count = 0;
        for (std::size_t k = 0; k < windows.size(); ++k) {
            if (k != i && do_overlap(windows[i], windows[k])) ++count;
        }
        if (count > largest) most.clear();
        if (count >= largest) most.push_back(i);
        largest = std::max(largest, count);
    }
    return most;
}

void leave_out_overlapping(OccupationList& list) {
    auto& windows = list.windows;
    for (auto most = most_overlapping(windows); !most.empty(); most = most_overlapping(windows)) {
        for (const std::size_t i : most) {
            const auto other =
                std::find_if(windows.begin(), windows.end(), [&](const OccupationWindow& window) {
                    return &window != &windows[i] && do_overlap(window, windows[i]);
                });
            leave_out(list.left_out, list.warnings, windows[i], text::marked("overlaps another"),
                      text::message(", {}", named(*other)));
        }
        for (auto i = most.rbegin(); i != most.rend(); ++i)
            windows.erase(windows.begin() + static_cast<std::ptrdiff_t>(*i));
    }
}

/// Keeps the windows that start at or after `from` and before `to`.
/// @throws InputError  none starts in that time.
void keep_between(std::vector<OccupationWindow>& windows, const std::optional<UtcTime>& from,
                  const std::optional<UtcTime>& to, const std::filesystem::path& origin) {
    if (windows.empty()) return;
    const UtcTime first = windows.front().start, last = windows.back().start;
    std::erase_if(windows, [&](const OccupationWindow& window) {
        return (from && window.start < *from) || (to && window.start >= *to);
    });
    if (windows.empty()) {
        throw InputError(fmt::format(
            "{}: no occupation starts{}{}{}; allowed: a time that includes a start; the first is "
            "at {}, the last at {}",
            origin.string(), from ? fmt::format(" from {} on", to_rfc3339(*from)) : "",
            from && to ? " and" : "", to ? " before " + to_rfc3339(*to) : "", to_rfc3339(first),
            to_rfc3339(last)));
    }
}

/// Keeps the occupations of the last survey day, with a warning if there are others.
void keep_last_day(std::vector<events::Occupation>& occupations, OccupationList& list,
                   const std::filesystem::path& origin) {
    if (occupations.empty()) return;
    const std::size_t all = occupations.size();
    const UtcTime last = occupations.back().set_ups.back().start;
    occupations = events::survey_day(std::move(occupations), last);
    if (occupations.size() == all) return;
    list.warnings.push_back(text::message(
        "{}: only the last day is used, from {} on; occupations of earlier days: {}; use from_utc "
        "and to_utc to choose others",
        origin.string(), to_rfc3339(occupations.front().set_ups.front().start),
        all - occupations.size()));
}

/// Stops the running occupation at `until`, else after the end of the record, or at the next later
/// start; returns its key.
std::string stop_running(events::OccupationReplay& replay, const std::optional<UtcTime>& until) {
    if (!replay.running()) return {};
    UtcTime end = until.value_or(replay.running()->set_ups.back() + events::kSurveyNight);
    const std::string key = replay.running()->key;
    for (const events::Occupation& other : replay.finished()) {
        const UtcTime start = other.set_ups.front().start;
        if (start > replay.running()->start) end = std::min(end, start);
    }
    replay.take({"stop", end, {}, {}, {}});
    return key;
}

UtcTime instant(const text::CsvTable& table, std::size_t row, std::string_view column) {
    const auto time = parse_rfc3339_in_zone(table.cell(row, column), std::chrono::minutes(0));
    if (!time) table.refuse(row, column, "not an instant", "YYYY-MM-DDThh:mm:ssZ");
    return *time;
}

}  // namespace

OccupationList read_occupation_table(const std::filesystem::path& file,
                                     const std::vector<text::Site>& sites,
                                     const std::optional<UtcTime>& from,
                                     const std::optional<UtcTime>& to) {
    const text::CsvTable table = text::read_csv(file);
    OccupationList list;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        OccupationWindow window;
        window.site = table.cell(row, "site");
        if (text::find_site(sites, window.site) == nullptr)
            table.refuse(row, "site", "unknown", "a name of the table of sites");
        const double number = table.number(row, "occupation", 1.0, 1e6);
        window.occupation = static_cast<int>(number);
        if (static_cast<double>(window.occupation) != number)
            table.refuse(row, "occupation", "not whole", "1, 2, ...");
        window.start = instant(table, row, "start_utc");
        window.end = instant(table, row, "end_utc");
        const std::string used = table.has_column("used") ? table.cell(row, "used") : "";
        if (!used.empty() && used != "0" && used != "1")
            table.refuse(row, "used", "not a mark", "1, 0 or empty");
        window.is_flagged = used == "0";
        if (table.has_column("earth_tide_mgal")) {
            const auto tide = table.number_if_given(row, "earth_tide_mgal", -1.0, 1.0);
            if (tide) window.given_tide = MilliGal(*tide);
        }
        if (table.has_column("instrument_height_m"))
            window.instrument_height = instrument_height(table, row);
        if (const std::string face = table.has_column("face") ? table.cell(row, "face") : "";
            !face.empty()) {
            window.face.entered = events::parse_face(face);
            if (!window.face.entered) table.refuse(row, "face", "not a face", "+, - or empty");
        }
        list.windows.push_back(std::move(window));
    }
    sort_by_start(list.windows);
    keep_between(list.windows, from, to, file);
    return list;
}

OccupationList read_logged_occupations(const std::filesystem::path& events,
                                       const std::optional<UtcTime>& from,
                                       const std::optional<UtcTime>& to,
                                       const std::optional<UtcTime>& running_until) {
    const events::EventLog log = events::read_events(events);
    OccupationList list;
    for (const events::EventDamage& damage : log.damage) {
        list.warnings.push_back(text::message("{}:{}: not an event, skipped",
                                              damage.file.filename().string(), damage.line));
    }
    events::OccupationReplay replay(log.events);
    const std::string last_key = stop_running(replay, running_until);
    if (running_until) list.running_key = last_key;
    auto occupations = replay.finished();
    if (!from && !to) keep_last_day(occupations, list, events);
    for (const events::Occupation& occupation : occupations) {
        const bool is_last = occupation.key == last_key;
        for (const events::Occupation::SetUp& set_up : occupation.set_ups) {
            // The samples of a set-up that was begun just now are not in the journal yet.
            if (is_last && running_until && set_up.end <= set_up.start) continue;
            list.windows.push_back(
                {{occupation.site, occupation.number, occupation.key}, set_up.start, set_up.end});
            list.windows.back().not_moved_until = occupation.not_moved_until;
            list.windows.back().face = set_up.face;
        }
        if (list.windows.empty() || list.windows.back().key != occupation.key) continue;
        list.windows.back().is_last = is_last;
        if (!occupation.is_stopped || (is_last && !running_until))
            list.windows.back().notes.emplace_back("no-stop");
    }
    sort_by_start(list.windows);
    keep_between(list.windows, from, to, events);
    for (const OccupationWindow& window : list.windows) {
        if (!window.notes.empty())
            list.warnings.push_back(
                window.is_last
                    ? text::message("{} has no stop: it lasts until the end of the record, six "
                                    "hours at most",
                                    named(window))
                    : text::message("{} has no stop: it lasts until the next start, at {}",
                                    named(window), to_rfc3339(window.end)));
    }
    return list;
}

OccupationList drop_invalid_occupations(OccupationList list, const std::vector<text::Site>& sites,
                                        const std::filesystem::path& origin) {
    std::vector<OccupationWindow> windows;
    for (OccupationWindow& window : list.windows) {
        const auto drop = [&](const std::string& reason, const text::Message& detail) {
            leave_out(list.left_out, list.warnings, window, reason, detail);
        };
        if (text::find_site(sites, window.site) == nullptr) {
            drop(text::marked("not in the table of sites"), {});
        } else if (window.end <= window.start) {
            drop(text::marked("ends before it starts"),
                 text::message(", at {}", to_rfc3339(window.end)));
        } else {
            windows.push_back(std::move(window));
        }
    }
    list.windows = std::move(windows);
    sort_by_start(list.windows);
    leave_out_overlapping(list);
    if (list.windows.empty()) {
        list.warnings.insert(list.warnings.begin(), origin.string() + ": no occupation");
        const char* const without_windows = list.running_key.empty() ? "no_stay" : "no_reading";
        throw Refused(list.left_out.empty() ? without_windows : "no_usable_stay",
                      text::joined(text::in_english(list.warnings), "; ") +
                          "; allowed: at least one, with its end");
    }
    return list;
}

void leave_out(std::vector<LeftOut>& left_out, std::vector<text::Message>& warnings,
               const OccupationWindow& window, const std::string& reason,
               const text::Message& detail) {
    left_out.push_back(
        {window.site, window.occupation, window.start, window.end, reason, window.key});
    warnings.push_back(
        text::message("{} is left out: {}{}", named(window), text::marked_message(reason), detail));
}

}  // namespace a351::corrector::reading
