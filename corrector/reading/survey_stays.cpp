#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "corrector/reading/occupation_rows.hpp"
#include "corrector/reading/refused.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

/// Returns the number of a set-up in its stay, from 1; std::nullopt if the stay has one set-up.
std::optional<int> set_up_number(const std::vector<OccupationWindow>& windows, std::size_t i) {
    int number = 1, count = 0;
    for (std::size_t k = 0; k < windows.size(); ++k) {
        if (!is_same_stay(windows[k], windows[i])) continue;
        ++count;
        if (k < i) ++number;
    }
    return count > 1 ? std::optional(number) : std::nullopt;
}

std::pair<OccupationList, Amendments> read_occupations(const SurveySource& source,
                                                       std::vector<text::Site>& sites) {
    const bool is_logged = source.occupations.empty();
    const auto origin = is_logged ? source.root / "events" : source.occupations;
    OccupationList list =
        is_logged ? read_logged_occupations(origin, source.from, source.to, source.running_until)
                  : read_occupation_table(origin, sites, source.from, source.to);
    for (std::size_t i = 0; i < list.windows.size(); ++i)
        list.windows[i].listed = {list.windows[i].site, list.windows[i].occupation,
                                  set_up_number(list.windows, i)};
    Amendments amendments;
    if (!source.amendments.empty()) amendments = amend(list.windows, source.amendments, sites);
    return {drop_invalid_occupations(std::move(list), sites, origin), std::move(amendments)};
}

/// Reads sites, occupations and metadata, with the set-ups of all sensors.
SurveyStays read_all_stays(const SurveySource& source) {
    SurveyStays stays;
    stays.sites = text::read_sites(source.sites);
    std::tie(stays.list, stays.amendments) = read_occupations(source, stays.sites);
    stays.metadata = source.root / "metadata" / "station.xml";
    if (!std::filesystem::exists(stays.metadata))
        throw Refused("no_metadata", stays.metadata.string() +
                                         ": no such file; allowed: the metadata that the daemon "
                                         "writes with the first data");
    stays.units = archive_series::read_unit_spans(stays.metadata);
    return stays;
}

/// Returns the sensors of the set-ups, by the end of their last one.
std::vector<std::string> units_of(const SurveyStays& stays) {
    std::vector<std::string> units;
    for (const OccupationWindow& window : stays.list.windows) {
        const std::string& unit = archive_series::span_at(stays.units, window.start).serial_number;
        std::erase(units, unit);
        units.push_back(unit);
    }
    return units;
}

/// Returns a finding if other sensors recorded in the time of the survey too.
std::optional<Finding> other_units(const SurveyStays& stays, const std::string& unit) {
    const auto& windows = stays.list.windows;
    const auto* const first = &archive_series::span_at(stays.units, windows.front().start);
    const auto* const last = &archive_series::span_at(stays.units, windows.back().end);
    if (first == last) return std::nullopt;
    std::string others;
    for (const auto* span = first + 1; span <= last; ++span)
        others += fmt::format(", {} {}", span->serial_number, to_rfc3339(span->from));
    Finding finding{
        .kind = FindingKind::other_unit, .code = "other_unit", .time = (first + 1)->from};
    finding.text = text::message(
        "several sensors recorded (from when each): {}{}; these are the readings of {}, with its "
        "own constant and response to temperature",
        first->serial_number, others, unit);
    return finding;
}

/// Keeps the set-ups of one sensor.
void keep_set_ups_of(SurveyStays& stays, const std::string& unit) {
    std::erase_if(stays.list.windows, [&](OccupationWindow& window) {
        const auto& span = archive_series::span_at(stays.units, window.start);
        window.end = std::min(window.end, span.to);
        return span.serial_number != unit;
    });
}

}  // namespace

std::vector<std::string> units_of(const SurveySource& source) {
    return units_of(read_all_stays(source));
}

SurveyStays read_survey_inputs(const SurveySource& source) {
    SurveyStays stays = read_all_stays(source);
    const std::vector<std::string> units = units_of(stays);
    if (source.unit.empty() && units.size() > 1)
        throw InputError(fmt::format(
            "{}: root = {}: the set-ups are of several sensors ({}), which have no constant in "
            "common; allowed: set-ups of one of them, by from_utc and to_utc",
            source.path.string(), source.root.string(), text::joined(units)));
    const std::string unit = source.unit.empty() ? units.front() : source.unit;
    if (auto finding = other_units(stays, unit)) stays.findings.push_back(std::move(*finding));
    keep_set_ups_of(stays, unit);
    if (stays.list.windows.empty())
        throw Refused("no_usable_stay",
                      fmt::format("{}: root = {}: no set-up is of the sensor {}",
                                  source.path.string(), source.root.string(), unit));
    const UtcTime start = stays.list.windows.front().start;
    stays.epoch = archive_series::epoch_of(start, station::read_station_xml(stays.metadata, start),
                                           stays.metadata);
    return stays;
}

}  // namespace a351::corrector::reading
