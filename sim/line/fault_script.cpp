#include "sim/line/fault_script.hpp"

#include <algorithm>
#include <limits>

#include "protocol/text/text_file.hpp"

namespace a351::sim::line {
namespace {

constexpr double kLatest_s = 1e9;
constexpr double kMostPerHour = 1e6;
constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

/// Returns true for kinds that need no setting by the author of the script.
bool can_be_random(std::string_view kind) {
    return kind != "other_unit" && kind != "change_settings" && kind != "overrun";
}

PlannedFault read_planned(text::TomlTable& table, UtcTime start, const FaultRules& rules) {
    PlannedFault planned;
    const std::string kind = table.string_or("kind", "");
    const int instants = (table.has("at_s") ? 1 : 0) + (table.has("at_utc") ? 1 : 0) +
                         (table.has("at_frame") ? 1 : 0);
    if (instants != 1) {
        table.refuse("kind", instants == 0 ? "no instant" : "several instants",
                     "one of at_s, at_utc, at_frame");
    }
    if (const auto seconds = table.number("at_s", 0.0, kLatest_s))
        planned.at = later_by(*seconds, start);
    if (const std::string text = table.string_or("at_utc", ""); table.has("at_utc")) {
        planned.at = parse_rfc3339(text);
        if (!planned.at)
            table.refuse("at_utc", "not an instant", "RFC 3339, such as 2017-07-16T00:00:00Z");
    }
    if (table.has("at_frame")) planned.at_frame = table.integer_or("at_frame", 0, 0, kMost);
    planned.fault = read_fault(table, kind, rules);
    table.require_all_read();
    return planned;
}

}  // namespace

FaultScript parse_fault_script(std::string_view toml, const std::filesystem::path& origin,
                               UtcTime start, const FaultRules& rules) {
    text::TomlTable root = text::parse_toml(toml, origin);
    FaultScript script;
    script.answers_cut_frames = root.boolean_or("answers_cut_frames", false);
    for (text::TomlTable& table : root.tables("fault"))
        script.planned.push_back(read_planned(table, start, rules));
    text::TomlTable random = root.table("random");
    script.seed = static_cast<std::uint64_t>(random.integer_or("seed", 1, 0, kMost));
    const auto read_rate = [&](std::string_view kind) {
        const double per_h = random.number_or(std::string(kind) + "_per_h", 0.0, 0.0, kMostPerHour);
        if (per_h > 0.0) script.random.push_back({parse_fault(kind, rules), per_h});
    };
    for (const std::string_view kind : fault_kinds()) {
        if (can_be_random(kind)) read_rate(kind);
    }
    for (const std::string_view kind : rules.oven_kinds) read_rate(kind);
    random.require_all_read();
    root.require_all_read();
    return script;
}

FaultScript read_fault_script(const std::filesystem::path& file, UtcTime start,
                              const FaultRules& rules) {
    return parse_fault_script(text::read_text_file(file), file, start, rules);
}

FaultSchedule::FaultSchedule(const FaultScript& script, UtcTime start) : planned_(script.planned) {
    for (const RandomFaults& faults : script.random) {
        random_.push_back({faults.fault, faults.per_h,
                           noise::RandomStream(script.seed, faults.fault.name), start});
        draw_next(random_.back());
    }
    find_next();
}

void FaultSchedule::draw_next(RandomKind& kind) {
    kind.next = later_by(kind.waits.exponential() * kSecondsPerHour / kind.per_h, kind.next);
}

void FaultSchedule::find_next() {
    next_at_ = UtcTime::max();
    next_frame_ = std::numeric_limits<std::int64_t>::max();
    for (const PlannedFault& planned : planned_) {
        if (planned.at) next_at_ = std::min(next_at_, *planned.at);
        if (planned.at_frame) next_frame_ = std::min(next_frame_, *planned.at_frame);
    }
    for (const RandomKind& kind : random_) next_at_ = std::min(next_at_, kind.next);
}

std::optional<Fault> FaultSchedule::take_due(UtcTime now, std::int64_t frames_made) {
    if (now < next_at_ && frames_made < next_frame_) return std::nullopt;
    std::optional<Fault> due;
    if (frames_made >= next_frame_) {
        const auto found = std::ranges::find(planned_, next_frame_, &PlannedFault::at_frame);
        due = found->fault;
        planned_.erase(found);
    } else if (const auto found = std::ranges::find(planned_, next_at_, &PlannedFault::at);
               found != planned_.end()) {
        due = found->fault;
        planned_.erase(found);
    } else {
        const auto kind = std::ranges::find(random_, next_at_, &RandomKind::next);
        due = kind->fault;
        draw_next(*kind);
    }
    find_next();
    return due;
}

}  // namespace a351::sim::line
