#include "sim/line/fault.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "protocol/wire/registers.hpp"

namespace a351::sim::line {
namespace {

/// Names in the order of FaultKind.
constexpr std::array<std::string_view, 24> kNames{
    "flip_bit",    "bad_checksum",    "drop_bytes",     "insert_bytes",
    "garbage",     "duplicate_frame", "reorder_frames", "truncate_frame",
    "lose_frames", "counter_jump",    "counter_stuck",  "counter_reset",
    "error_flags", "reset",           "power_cycle",    "stop",
    "other_unit",  "change_settings", "change_baud",    "failing_tests",
    "silence",     "stall",           "hang_up",        "overrun"};
static_assert(kNames.size() == static_cast<std::size_t>(FaultKind::oven));

constexpr int kMostFrames = 1'000'000;
constexpr int kMostBytes = 1'000'000;
constexpr double kLongest_s = 1e6;

int integer(text::TomlTable& table, std::string_view key, int fallback, int low, int high) {
    return static_cast<int>(table.integer_or(key, fallback, low, high));
}

std::string list_of_kinds(const FaultRules& rules) {
    std::vector<std::string> kinds(kNames.begin(), kNames.end());
    kinds.insert(kinds.end(), rules.oven_kinds.begin(), rules.oven_kinds.end());
    return text::joined(kinds);
}

/// Returns a number that is one of `values`; if it is absent, `fallback`.
int coded(text::TomlTable& table, std::string_view key, int fallback,
          std::span<const wire::Coded> values) {
    const int value = integer(table, key, fallback, 1, kMostBytes);
    if (!table.has(key) || std::ranges::count(values, value, &wire::Coded::value) > 0) return value;
    std::vector<std::string> allowed;
    for (const wire::Coded& each : values) allowed.push_back(std::to_string(each.value));
    table.refuse(key, "the device has no such value", text::joined(allowed));
}

void read_settings(text::TomlTable& table, const FaultRules& rules, Fault& fault) {
    fault.output_rate_hz = coded(table, "output_rate_hz", 0, rules.profile.output_rates_hz);
    fault.filter = table.string_or("filter", "");
    if (!fault.filter.empty() && rules.profile.filter_named(fault.filter) == nullptr) {
        std::vector<std::string> allowed;
        for (const auto& filter : rules.profile.filters) allowed.emplace_back(filter.name);
        table.refuse("filter", "the device has no such filter", text::joined(allowed));
    }
    fault.burst_ctrl = integer(table, "burst_ctrl", 0, 1, 0xFFFF);
    if (table.has("burst_ctrl") &&
        !wire::BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(fault.burst_ctrl))) {
        table.refuse("burst_ctrl", "not a layout",
                     "FLAG_OUT 0x8000, TEMP_OUT 0x4000, an axis of "
                     "0x0700, COUNT_OUT 0x0002, CHKSM_OUT 0x0001");
    }
    if (fault.output_rate_hz == 0 && fault.filter.empty() && fault.burst_ctrl == 0)
        table.refuse("kind", "changes nothing", "with output_rate_hz, filter or burst_ctrl");
}

void read_serial_number(text::TomlTable& table, Fault& fault) {
    fault.serial_number = table.string_or("serial_number", "");
    if (fault.serial_number.size() != 8)
        table.refuse("serial_number", "not a serial number", "eight characters");
    fault.when_unplugged = table.boolean_or("when_unplugged", false);
}

/// Returns a setting of a command as a TOML line; strings have no quotes in a command.
std::string as_toml(std::string_view key, std::string_view value) {
    const bool is_text = key == "kind" || key == "serial_number" || key == "filter";
    return is_text ? fmt::format("{} = \"{}\"\n", key, value)
                   : fmt::format("{} = {}\n", key, value);
}

/// Returns true if TOML reads the word as a value and nothing else.
bool is_plain(std::string_view word) {
    return !word.empty() && word.find_first_of("\"'\\[]{}#") == std::string_view::npos;
}

}  // namespace

UtcTime later_by(double seconds, UtcTime then) {
    constexpr double kFar_s = 3e9;  // 95 years
    if (!(seconds < kFar_s)) return UtcTime::max();
    const Nanoseconds wait = from_seconds(seconds);
    return then < UtcTime::max() - wait ? then + wait : UtcTime::max();
}

std::span<const std::string_view> fault_kinds() noexcept { return kNames; }

Fault read_fault(text::TomlTable& table, const std::string& kind, const FaultRules& rules) {
    Fault fault;
    fault.name = kind;
    const auto found = std::ranges::find(kNames, kind);
    fault.kind = static_cast<FaultKind>(found - kNames.begin());
    if (fault.kind == FaultKind::oven &&
        std::ranges::count(rules.oven_kinds, std::string_view(kind)) == 0) {
        table.refuse("kind", "not a known value", list_of_kinds(rules));
    }
    using enum FaultKind;
    const auto is = [&fault](auto... kinds) { return ((fault.kind == kinds) || ...); };
    if (is(flip_bit)) fault.bits = integer(table, "bits", 1, 1, 16);
    if (is(drop_bytes, insert_bytes)) fault.bytes = integer(table, "bytes", 1, 1, kMostBytes);
    if (is(garbage)) fault.bytes = integer(table, "bytes", 100, 1, kMostBytes);
    if (fault.kind <= lose_frames || is(counter_jump, counter_stuck, error_flags))
        fault.count = integer(table, "count", 1, 1, kMostFrames);
    if (is(oven)) fault.count = integer(table, "count", 1, -1, kMostFrames);  // -1: see oven::Port.
    if (is(counter_jump)) fault.ticks = integer(table, "ticks", 0, 1, 0xFFFF);
    if (is(error_flags, failing_tests)) {
        const int least = is(error_flags) ? 1 : 0;
        fault.diag_stat = integer(table, "diag_stat", wire::kDiagHardError, least, 0xFFFF);
    }
    if (is(other_unit)) read_serial_number(table, fault);
    if (is(change_settings)) read_settings(table, rules, fault);
    if (is(change_baud)) fault.baud = coded(table, "baud", 115200, rules.profile.baud_rates);
    if (is(overrun) && rules.speed > FaultRules::kFastestOverrun) {
        table.refuse("kind", "the emulator runs too fast for it",
                     "up to 50 simulated seconds per second");
    }
    if (is(silence, stall, hang_up, overrun))
        fault.seconds = table.number_or("seconds", is(overrun) ? 0.0 : 5.0, 0.0, kLongest_s);
    if (is(hang_up)) fault.loses_power = table.boolean_or("loses_power", false);
    return fault;
}

Fault parse_fault(std::string_view words, const FaultRules& rules) {
    std::istringstream in{std::string(words)};
    std::string word;
    in >> word;
    if (!is_plain(word)) {
        throw InputError(
            fmt::format("control: {}: not a known value; allowed: {}", word, list_of_kinds(rules)));
    }
    std::string toml = as_toml("kind", word);
    while (in >> word) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string key = word.substr(0, equals);
        if (!is_plain(word) || key.empty() || equals + 1 >= word.size())
            throw InputError("control: " + word + ": not a setting; allowed: key=value");
        toml += as_toml(key, word.substr(equals + 1));
    }
    text::TomlTable table = text::parse_toml(toml, "control");
    Fault fault = read_fault(table, table.string_or("kind", ""), rules);
    table.require_all_read();
    return fault;
}

}  // namespace a351::sim::line
