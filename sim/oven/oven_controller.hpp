#pragma once
/// @file
/// The temperature controller as its serial port shows it: variables, status, operation commands,
/// and the reasons of refusals.  No bytes, no I/O, no clock.
/// Omron E5_C Communications Manual (H175-E1): section 4-1-3 error codes, 4-4 functions, 5
/// variables and status.

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "sim/oven/oven_variables.hpp"
#include "sim/plant/oven_plant.hpp"

namespace a351::sim::oven {

/// Reason for which a request is answered by an exception.  If several apply, the lowest is given.
enum class Refusal : std::uint8_t {
    function = 1,  ///< No such function.
    address = 2,   ///< No variable at the first address, or it cannot be written.
    data = 3,      ///< Wrong count, value out of range, no such command.
    operation = 4  ///< Not possible now: writing is off, or wrong setup area.
};

/// Bits of the status that this controller can show (H175 section 5).
namespace oven_status {
inline constexpr std::uint32_t kInputError = 1U << 6;
inline constexpr std::uint32_t kHeating = 1U << 8;
inline constexpr std::uint32_t kAlarm1 = 1U << 12;
inline constexpr std::uint32_t kRamMode = 1U << 20;
inline constexpr std::uint32_t kRamDiffers = 1U << 21;
inline constexpr std::uint32_t kSetupArea1 = 1U << 22;
inline constexpr std::uint32_t kStopped = 1U << 24;
inline constexpr std::uint32_t kWritingEnabled = 1U << 25;
}  // namespace oven_status

/// Code of the operation command that restarts the controller (H175 section 4).
inline constexpr std::uint8_t kSoftwareReset = 0x06;

/// The controller of one oven.  Only writes change the plant's set point, tuning and state.
///
/// Differences from the device:
/// - Auto-tuning, manual mode, remote and multiple set points are refused as not possible now.
/// - Heater current, cooling and status 2 read 0.
/// - Only K couples (input types 5 and 6) can be chosen.
/// - Alarm 1 is an upper limit relative to the set point; value 0 switches it off.
/// - D, the input filter and the alarm's second pair of limits are stored without effect.
///
/// Assumed, because the manual does not say: an input error shows the upper end of the range;
/// registers that are not in the map read 0 if the first register of the request exists.
class Controller {
public:
    explicit Controller(plant::OvenPlant& plant);

    /// Reads `count` registers, 1 ... 106, from `address` on; in four-byte mode both are even.
    [[nodiscard]] std::variant<std::vector<std::uint16_t>, Refusal> read(std::uint16_t address,
                                                                         std::size_t count) const;

    /// Writes up to 104 registers: all of them or none.
    /// @return  std::nullopt if they were written.
    [[nodiscard]] std::optional<Refusal> write(std::uint16_t address,
                                               std::span<const std::uint16_t> words);

    /// Executes an operation command with its parameter.
    [[nodiscard]] std::optional<Refusal> operate(std::uint8_t command, std::uint8_t parameter);

    /// Restarts after power-off or a software reset: content that is only in RAM is lost.
    void restart();

    /// Returns false once its parameters have been initialised, which sets another protocol.
    [[nodiscard]] bool speaks_modbus() const noexcept { return speaks_modbus_; }

    [[nodiscard]] std::uint32_t status() const;

private:
    /// Content of the non-volatile memory; temperatures in 0.1 degC.
    struct Settings {
        std::int32_t set_point = 0;
        std::int32_t alarm_1 = 0, alarm_1_upper = 0, alarm_1_lower = 0;
        std::int32_t proportional_band = 0;
        std::int32_t integral_time_s = 0, derivative_time_s = 0;
        std::int32_t input_filter = 0;
        std::int32_t input_type = 6;
        plant::ControllerKind kind = plant::ControllerKind::pi;
        bool is_running = true;
        bool is_writing_enabled = false;

        bool operator==(const Settings&) const = default;
    };

    /// A number that can be written, within its limits.
    struct Setting {
        Variable variable;
        std::int32_t Settings::*place;
        std::int32_t low, high;
        bool is_temperature;  ///< Shown and written in the display's last digit.
    };
    /// Returns the setting of a variable; null if it has none.
    [[nodiscard]] static const Setting* find_setting(Variable variable);

    [[nodiscard]] std::int32_t value(Variable variable) const;
    [[nodiscard]] std::int32_t shown(std::int32_t tenths) const;
    [[nodiscard]] std::int32_t process_value() const;
    [[nodiscard]] std::uint32_t sensor_status() const;
    [[nodiscard]] std::optional<Refusal> set(Variable variable, std::int32_t digits,
                                             Settings& next) const;
    void put_in_force(const Settings& next);
    void enter_setup_area(bool is_in_setup);
    [[nodiscard]] std::optional<Refusal> execute(std::uint8_t command, std::uint8_t parameter);

    plant::OvenPlant& plant_;
    Settings settings_;
    Settings stored_;
    bool is_in_ram_mode_ = false;
    bool is_in_setup_ = false;
    std::uint32_t held_status_ = 0;  ///< Bits of the sensor on entry into setup area 1.
    bool speaks_modbus_ = true;
};

}  // namespace a351::sim::oven
