#include "sim/oven/oven_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace a351::sim::oven {
namespace {

constexpr std::size_t kMostRead = 106, kMostWritten = 104;  // H175, 4-4-1 and 4-4-2.

constexpr std::int32_t kDisplayLow = -1999, kDisplayHigh = 9999;       ///< Four digits and a sign.
constexpr std::int32_t kInputRangeLow = -200, kInputRangeHigh = 5000;  ///< K couple, 0.1 degC.
constexpr std::int32_t kTypeKInDegrees = 5, kTypeKInTenths = 6;
constexpr std::int32_t kTenDegrees = 100;

enum Command : std::uint8_t {
    kCommunicationWriting = 0x00,
    kRunStop = 0x01,
    kMultiSetPoint = 0x02,
    kAutoTuning = 0x03,
    kWriteMode = 0x04,
    kSaveRam = 0x05,
    kMoveToSetupArea1 = 0x07,
    kMoveToProtectLevel = 0x08,
    kAutoManual = 0x09,
    kInitialise = 0x0B,
    kCancelAlarmLatch = 0x0C,
    kSetPointMode = 0x0D,
    kInvertDirection = 0x0E,
    kProgramStart = 0x11,
};

/// Largest parameter of each command.
struct KnownCommand {
    std::uint8_t command, most_parameter;
};
constexpr std::array kKnownCommands{
    KnownCommand{kCommunicationWriting, 1},
    KnownCommand{kRunStop, 1},
    KnownCommand{kMultiSetPoint, 7},
    KnownCommand{kAutoTuning, 2},
    KnownCommand{kWriteMode, 1},
    KnownCommand{kSaveRam, 0},
    KnownCommand{kSoftwareReset, 0},
    KnownCommand{kMoveToSetupArea1, 0},
    KnownCommand{kMoveToProtectLevel, 0},
    KnownCommand{kAutoManual, 1},
    KnownCommand{kInitialise, 0},
    KnownCommand{kCancelAlarmLatch, 5},
    KnownCommand{kSetPointMode, 1},
    KnownCommand{kInvertDirection, 1},
    KnownCommand{kProgramStart, 1},
};

bool is_known(std::uint8_t command, std::uint8_t parameter) {
    const auto found = std::ranges::find(kKnownCommands, command, &KnownCommand::command);
    if (command == kCancelAlarmLatch && parameter == 0x0F) return true;  // All alarms.
    return found != kKnownCommands.end() && parameter <= found->most_parameter;
}

std::int32_t rounded(double value) { return static_cast<std::int32_t>(std::lround(value)); }

std::int32_t to_tenths(DegC temperature) { return rounded(temperature.value() * 10.0); }

bool lies_within(std::int32_t value, std::int32_t low, std::int32_t high) {
    return low <= value && value <= high;
}

}  // namespace

Controller::Controller(plant::OvenPlant& plant) : plant_(plant) {
    settings_.set_point = to_tenths(plant.set_point());
    settings_.alarm_1 = kTenDegrees;
    settings_.proportional_band = rounded(plant.tuning().proportional_band_degc * 10.0);
    settings_.integral_time_s = rounded(plant.tuning().integral_time_s);
    settings_.kind = plant.controller();
    stored_ = settings_;
}

std::int32_t Controller::shown(std::int32_t tenths) const {
    return settings_.input_type == kTypeKInTenths ? tenths : rounded(tenths / 10.0);
}

std::int32_t Controller::process_value() const {
    return plant_.is_sensor_broken() ? kInputRangeHigh : to_tenths(plant_.controller_reading());
}

std::uint32_t Controller::sensor_status() const {
    std::uint32_t bits = 0;
    if (plant_.is_sensor_broken()) bits |= oven_status::kInputError;
    const bool is_high = process_value() >= settings_.set_point + settings_.alarm_1;
    if (settings_.alarm_1 > 0 && is_high) bits |= oven_status::kAlarm1;
    return bits;
}

std::uint32_t Controller::status() const {
    std::uint32_t bits = is_in_setup_ ? held_status_ : sensor_status();
    if (plant_.drive() > 0.0) bits |= oven_status::kHeating;
    if (is_in_ram_mode_) bits |= oven_status::kRamMode;
    if (settings_ != stored_) bits |= oven_status::kRamDiffers;
    if (is_in_setup_) bits |= oven_status::kSetupArea1;
    if (!settings_.is_running) bits |= oven_status::kStopped;
    if (settings_.is_writing_enabled) bits |= oven_status::kWritingEnabled;
    return bits;
}

const Controller::Setting* Controller::find_setting(Variable variable) {
    using Limits = std::numeric_limits<std::int32_t>;
    constexpr std::int32_t kLow = Limits::min(), kHigh = Limits::max();  // Only the display's.
    static constexpr std::array kSettings{
        Setting{Variable::set_point, &Settings::set_point, kInputRangeLow, kInputRangeHigh, true},
        Setting{Variable::alarm_1, &Settings::alarm_1, kLow, kHigh, true},
        Setting{Variable::alarm_1_upper, &Settings::alarm_1_upper, kLow, kHigh, true},
        Setting{Variable::alarm_1_lower, &Settings::alarm_1_lower, kLow, kHigh, true},
        Setting{Variable::input_filter, &Settings::input_filter, 0, kHigh, false},
        Setting{Variable::proportional_band, &Settings::proportional_band, 1, kHigh, false},
        Setting{Variable::integral_time, &Settings::integral_time_s, 0, kHigh, false},
        Setting{Variable::derivative_time, &Settings::derivative_time_s, 0, kHigh, false},
        Setting{Variable::input_type, &Settings::input_type, kTypeKInDegrees, kTypeKInTenths,
                false},
    };
    const auto found = std::ranges::find(kSettings, variable, &Setting::variable);
    return found == kSettings.end() ? nullptr : &*found;
}

std::int32_t Controller::value(Variable variable) const {
    if (const Setting* const setting = find_setting(variable)) {
        const std::int32_t value = settings_.*setting->place;
        return setting->is_temperature ? shown(value) : value;
    }
    switch (variable) {
        case Variable::process_value:
            return shown(process_value());
        case Variable::status:
            return static_cast<std::int32_t>(status());
        case Variable::status_high:
            return static_cast<std::int32_t>(status() >> 16);
        case Variable::internal_set_point:
            return shown(settings_.set_point);
        case Variable::drive_heating:
            return rounded(plant_.drive() * 1000.0);
        case Variable::decimal_point:
            return settings_.input_type == kTypeKInTenths ? 1 : 0;
        case Variable::control_kind:
            return settings_.kind == plant::ControllerKind::on_off ? 0 : 1;
        default:
            return 0;  // Heater current, cooling and status 2.
    }
}

std::variant<std::vector<std::uint16_t>, Refusal> Controller::read(std::uint16_t address,
                                                                   std::size_t count) const {
    const bool is_two_byte = is_two_byte_address(address);
    if (find_variable(address) == nullptr) return Refusal::address;
    if (!is_two_byte && count % 2 != 0) return Refusal::address;
    if (count < 1 || count > kMostRead) return Refusal::data;
    std::vector<std::uint16_t> words(count, 0);
    const std::size_t step = is_two_byte ? 1 : 2;
    for (std::size_t i = 0; i < count; i += step) {
        const VariableEntry* entry = find_variable(static_cast<std::uint16_t>(address + i));
        if (entry == nullptr) continue;
        const auto bits = static_cast<std::uint32_t>(value(entry->variable));
        if (!is_two_byte) words[i] = static_cast<std::uint16_t>(bits >> 16);
        words[i + step - 1] = static_cast<std::uint16_t>(bits);
    }
    return words;
}

std::optional<Refusal> Controller::set(Variable variable, std::int32_t digits,
                                       Settings& next) const {
    if (!lies_within(digits, kDisplayLow, kDisplayHigh)) return Refusal::data;
    const std::int32_t tenths = settings_.input_type == kTypeKInTenths ? digits : 10 * digits;
    if (variable == Variable::control_kind) {
        if (!lies_within(digits, 0, 1)) return Refusal::data;
        next.kind = digits == 0 ? plant::ControllerKind::on_off : plant::ControllerKind::pi;
        return std::nullopt;
    }
    const Setting* const setting = find_setting(variable);
    if (setting == nullptr) return Refusal::address;
    const std::int32_t value = setting->is_temperature ? tenths : digits;
    if (!lies_within(value, setting->low, setting->high)) return Refusal::data;
    next.*setting->place = value;
    return std::nullopt;
}

std::optional<Refusal> Controller::write(std::uint16_t address,
                                         std::span<const std::uint16_t> words) {
    const bool is_two_byte = is_two_byte_address(address);
    const std::size_t step = is_two_byte ? 1 : 2;
    if (find_variable(address) == nullptr) return Refusal::address;
    if (!is_two_byte && words.size() % 2 != 0) return Refusal::address;
    if (words.empty() || words.size() > kMostWritten) return Refusal::data;
    Settings next = settings_;
    bool is_for_setup = false;
    std::optional<Refusal> trouble;
    for (std::size_t i = 0; i < words.size(); i += step) {
        const VariableEntry* entry = find_variable(static_cast<std::uint16_t>(address + i));
        if (entry == nullptr || entry->level == WriteLevel::none) return Refusal::address;
        is_for_setup |= entry->level == WriteLevel::setup;
        const std::int32_t digits =
            is_two_byte ? static_cast<std::int16_t>(words[i])
                        : static_cast<std::int32_t>(std::uint32_t{words[i]} << 16 | words[i + 1]);
        if (const auto refusal = set(entry->variable, digits, next)) trouble = refusal;
    }
    if (trouble) return trouble;
    if (!settings_.is_writing_enabled || (is_for_setup && !is_in_setup_)) return Refusal::operation;
    put_in_force(next);
    return std::nullopt;
}

void Controller::put_in_force(const Settings& next) {
    if (next.set_point != settings_.set_point) plant_.set_set_point(DegC(next.set_point / 10.0));
    if (next.proportional_band != settings_.proportional_band ||
        next.integral_time_s != settings_.integral_time_s) {
        plant_.set_tuning({next.proportional_band / 10.0, double(next.integral_time_s)});
    }
    if (next.kind != settings_.kind) plant_.set_controller(next.kind);
    settings_ = next;
    if (!is_in_ram_mode_) stored_ = next;
    plant_.set_running(settings_.is_running && !is_in_setup_);
}

void Controller::enter_setup_area(bool is_in_setup) {
    held_status_ = sensor_status();
    is_in_setup_ = is_in_setup;
}

void Controller::restart() {
    is_in_ram_mode_ = false;
    enter_setup_area(false);
    put_in_force(stored_);
}

std::optional<Refusal> Controller::operate(std::uint8_t command, std::uint8_t parameter) {
    if (!is_known(command, parameter)) return Refusal::data;
    if (command != kCommunicationWriting && !settings_.is_writing_enabled)
        return Refusal::operation;
    return execute(command, parameter);
}

std::optional<Refusal> Controller::execute(std::uint8_t command, std::uint8_t parameter) {
    const auto unless = [](bool is_refused) {
        return is_refused ? std::optional(Refusal::operation) : std::nullopt;
    };
    Settings next = settings_;
    switch (command) {
        case kCommunicationWriting:
            next.is_writing_enabled = parameter == 1;
            break;
        case kRunStop:
            next.is_running = parameter == 0;
            break;
        case kWriteMode:
            is_in_ram_mode_ = parameter == 1;  // 0: put_in_force() below stores the RAM's content.
            break;
        case kSaveRam:
            stored_ = settings_;
            return std::nullopt;
        case kSoftwareReset:
            restart();
            return std::nullopt;
        case kMoveToSetupArea1:
            enter_setup_area(true);
            break;
        case kInitialise:
            if (is_in_setup_) speaks_modbus_ = false;
            return unless(!is_in_setup_);
        case kMoveToProtectLevel:
            return unless(is_in_setup_);
        case kAutoTuning:
            return unless(is_in_setup_ || parameter != 0);
        case kProgramStart:
            return Refusal::operation;
        case kCancelAlarmLatch:
            return std::nullopt;
        default:
            return unless(parameter != 0);
    }
    put_in_force(next);
    return std::nullopt;
}

}  // namespace a351::sim::oven
