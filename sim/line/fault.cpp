#include "sim/line/fault.hpp"

#include <algorithm>
#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/wire/burst_layout.hpp"
#include "protocol/wire/registers.hpp"

namespace a351::sim {
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

void add_to(std::string& list, std::string_view item) {
    list += (list.empty() ? "" : ", ") + std::string(item);
}

std::string list_of_kinds(const FaultRules& rules) {
    std::string list;
    for (const std::string_view name : kNames) add_to(list, name);
    for (const std::string_view name : rules.oven_kinds) add_to(list, name);
    return list;
}

/// Returns a number that is one of `values`; if it is absent, `fallback`.
int coded(text::TomlTable& table, std::string_view key, int fallback,
          std::span<const wire::Coded> values) {
    const int value = integer(table, key, fallback, 1, kMostBytes);
    if (!table.has(key) || std::ranges::count(values, value, &wire::Coded::value) > 0) return value;
    std::string allowed;
    for (const wire::Coded& each : values) add_to(allowed, std::to_string(each.value));
    table.refuse(key, "the device has no such value", allowed);
}

void read_settings(text::TomlTable& table, const FaultRules& rules, Fault& fault) {
    fault.output_rate_hz = coded(table, "output_rate_hz", 0, rules.profile.output_rates_hz);
    fault.filter = table.string_or("filter", "");
    if (!fault.filter.empty() && rules.profile.filter_named(fault.filter) == nullptr) {
        std::string allowed;
        for (const wire::FilterSpec& filter : rules.profile.filters) add_to(allowed, filter.name);
        table.refuse("filter", "the device has no such filter", allowed);
    }
    fault.burst_ctrl = integer(table, "burst_ctrl", 0, 1, 0xFFFF);
    if (table.has("burst_ctrl") &&
        !wire::BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(fault.burst_ctrl))) {
        table.refuse("burst_ctrl", "not a layout",
                     "FLAG_OUT 0x8000, TEMP_OUT 0x4000, an axis of "
                     "0x0700, COUNT_OUT 0x0002, CHKSM_OUT 0x0001");
    }
    if (fault.output_rate_hz == 0 && fault.filter.empty() && fault.burst_ctrl == 0) {
        table.refuse("kind", "changes nothing", "with output_rate_hz, filter or burst_ctrl");
    }
}

void read_serial_number(text::TomlTable& table, Fault& fault) {
    fault.serial_number = table.string_or("serial_number", "");
    if (fault.serial_number.size() != 8) {
        table.refuse("serial_number", "not a serial number", "eight characters");
    }
    fault.when_unplugged = table.boolean_or("when_unplugged", false);
}

/// Returns a setting of a command as a TOML line; strings have no quotes in a command.
std::string as_toml(std::string_view key, std::string_view value) {
    const bool is_text = key == "kind" || key == "serial_number" || key == "filter";
    return std::string(key) + " = " +
           (is_text ? '"' + std::string(value) + '"' : std::string(value)) + '\n';
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
    const auto count = [&] { fault.count = integer(table, "count", 1, 1, kMostFrames); };
    const auto seconds = [&](double fallback) {
        fault.seconds = table.number_or("seconds", fallback, 0.0, kLongest_s);
    };
    switch (fault.kind) {
        case FaultKind::flip_bit:
            fault.bits = integer(table, "bits", 1, 1, 16);
            count();
            break;
        case FaultKind::drop_bytes:
        case FaultKind::insert_bytes:
            fault.bytes = integer(table, "bytes", 1, 1, kMostBytes);
            count();
            break;
        case FaultKind::garbage:
            fault.bytes = integer(table, "bytes", 100, 1, kMostBytes);
            count();
            break;
        case FaultKind::bad_checksum:
        case FaultKind::duplicate_frame:
        case FaultKind::reorder_frames:
        case FaultKind::truncate_frame:
        case FaultKind::lose_frames:
        case FaultKind::counter_stuck:
            count();
            break;
        case FaultKind::counter_jump:
            count();
            fault.ticks = integer(table, "ticks", 0, 1, 0xFFFF);
            break;
        case FaultKind::error_flags:
            count();
            fault.diag_stat = integer(table, "diag_stat", wire::kDiagHardError, 1, 0xFFFF);
            break;
        case FaultKind::counter_reset:
        case FaultKind::reset:
        case FaultKind::power_cycle:
        case FaultKind::stop:
            break;
        case FaultKind::other_unit:
            read_serial_number(table, fault);
            break;
        case FaultKind::change_settings:
            read_settings(table, rules, fault);
            break;
        case FaultKind::change_baud:
            fault.baud = coded(table, "baud", 115200, rules.profile.baud_rates);
            break;
        case FaultKind::failing_tests:
            fault.diag_stat = integer(table, "diag_stat", wire::kDiagHardError, 0, 0xFFFF);
            break;
        case FaultKind::silence:
        case FaultKind::stall:
            seconds(5.0);
            break;
        case FaultKind::hang_up:
            seconds(5.0);
            fault.loses_power = table.boolean_or("loses_power", false);
            break;
        case FaultKind::oven:
            fault.count = integer(table, "count", 1, -1, kMostFrames);  // -1: see OvenPort.
            break;
        case FaultKind::overrun:
            if (rules.speed > FaultRules::kFastestOverrun) {
                table.refuse("kind", "the emulator runs too fast for it",
                             "up to 50 simulated seconds per second");
            }
            seconds(0.0);
            break;
    }
    return fault;
}

Fault parse_fault(std::string_view words, const FaultRules& rules) {
    std::istringstream in{std::string(words)};
    std::string word;
    in >> word;
    if (!is_plain(word)) {
        throw InputError("control: " + word +
                         ": not a known value; allowed: " + list_of_kinds(rules));
    }
    std::string toml = as_toml("kind", word);
    while (in >> word) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string key = word.substr(0, equals);
        if (!is_plain(word) || key.empty() || equals + 1 >= word.size()) {
            throw InputError("control: " + word + ": not a setting; allowed: key=value");
        }
        toml += as_toml(key, word.substr(equals + 1));
    }
    text::TomlTable table = text::parse_toml(toml, "control");
    Fault fault = read_fault(table, table.string_or("kind", ""), rules);
    table.require_all_read();
    return fault;
}

}  // namespace a351::sim
