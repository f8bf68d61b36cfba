#include "corrector/survey/occupation_list.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/record/event_log.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector {
namespace {

std::string described(const OccupationWindow& window) {
    return window.site + " (" + std::to_string(window.number) + ") from " +
           to_rfc3339(window.start) + " to " + to_rfc3339(window.end);
}

OccupationList in_order(OccupationList list, const std::filesystem::path& origin) {
    if (list.windows.empty()) {
        throw InputError(origin.string() + ": no occupation; allowed: at least one, with its end");
    }
    std::sort(list.windows.begin(), list.windows.end(),
              [](const auto& a, const auto& b) { return a.start < b.start; });
    for (std::size_t i = 0; i < list.windows.size(); ++i) {
        if (list.windows[i].end <= list.windows[i].start) {
            throw InputError(origin.string() + ": " + described(list.windows[i]) +
                             ": ends before it starts; allowed: a later end");
        }
        if (i > 0 && list.windows[i].start < list.windows[i - 1].end) {
            throw InputError(origin.string() + ": " + described(list.windows[i]) + " overlaps " +
                             described(list.windows[i - 1]) + "; allowed: one after the other");
        }
    }
    return list;
}

UtcTime instant(const text::CsvTable& table, std::size_t row, std::string_view column) {
    const auto time = parse_rfc3339_in_zone(table.cell(row, column), std::chrono::minutes(0));
    if (!time) table.refuse(row, column, "not an instant", "YYYY-MM-DDThh:mm:ssZ");
    return *time;
}

}  // namespace

OccupationList read_occupation_table(const std::filesystem::path& file,
                                     const std::vector<text::Site>& sites) {
    const text::CsvTable table = text::read_csv(file);
    OccupationList list;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        OccupationWindow window;
        window.site = table.cell(row, "site");
        if (text::find_site(sites, window.site) == nullptr) {
            table.refuse(row, "site", "unknown", "a name of the table of sites");
        }
        const double number = table.number(row, "occupation", 1.0, 1e6);
        window.number = static_cast<int>(number);
        if (static_cast<double>(window.number) != number) {
            table.refuse(row, "occupation", "not whole", "1, 2, ...");
        }
        window.start = instant(table, row, "start_utc");
        window.end = instant(table, row, "end_utc");
        const std::string used = table.has_column("used") ? table.cell(row, "used") : "";
        if (used != "" && used != "0" && used != "1") {
            table.refuse(row, "used", "not a mark", "1, 0 or empty");
        }
        window.is_flagged = used == "0";
        if (table.has_column("earth_tide_mgal")) {
            const auto tide = table.number_if_given(row, "earth_tide_mgal", -1.0, 1.0);
            if (tide) window.given_tide = MilliGal(*tide);
        }
        list.windows.push_back(std::move(window));
    }
    return in_order(std::move(list), file);
}

OccupationList read_logged_occupations(const std::filesystem::path& events,
                                       const std::vector<text::Site>& sites) {
    const record::EventLog log = record::read_events(events);
    OccupationList list;
    for (const record::EventDamage& damage : log.damage) {
        list.warnings.push_back(damage.file.filename().string() + ":" +
                                std::to_string(damage.line) + ": not an event, passed over");
    }
    for (const record::Occupation& occupation : record::occupations_of(log.events)) {
        if (text::find_site(sites, occupation.site) == nullptr) {
            list.warnings.push_back(events.string() + ": site = " + occupation.site + ", started " +
                                    to_rfc3339(occupation.set_ups.front().start) +
                                    ": not in the table of sites, left out");
            continue;
        }
        for (const record::Occupation::SetUp& set_up : occupation.set_ups) {
            list.windows.push_back({occupation.site, occupation.number, set_up.start, set_up.end,
                                    !occupation.used.value_or(true)});
        }
    }
    if (const auto site = record::running_site(log.events)) {
        list.warnings.push_back(events.string() + ": the last occupation, of " + *site +
                                ", has no stop, left out");
    }
    return in_order(std::move(list), events);
}

}  // namespace a351::corrector
