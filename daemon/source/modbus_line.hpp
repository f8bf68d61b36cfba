#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::daemon {

/// Reads registers of one unit over Modbus RTU, by libmodbus, on a port that it holds locked.
/// There is no function to write any.
class ModbusLine {
public:
    struct Settings {
        std::filesystem::path port = {};  ///< Device, pseudo-terminal, or a link to one.
        int baud = 9600;                  ///< One that libmodbus knows; others it takes for 9600.
        char parity = 'E';                ///< E, O or N.
        int unit = 1;                     ///< 1 ... 99.
        bool is_rs485 = false;  ///< The kernel's driver turns the line round (TIOCSRS485).
    };
    struct Answer {
        record::OvenOutcome outcome = record::OvenOutcome::no_port;
        std::vector<std::uint16_t> words;  ///< As many as were asked for if answered, else none.
        std::string trouble;               ///< Why it is not answered, in words.
        std::uint8_t exception = 0;        ///< Its code, if that is the outcome.
    };

    /// No read takes longer.
    static constexpr std::chrono::milliseconds kResponseTimeout{300};

    /// Resolves links, locks the port, opens and sets it up.
    /// @throws PortError
    explicit ModbusLine(const Settings& settings);
    ~ModbusLine();

    /// Reads `count` registers (1 ... 125) from `address` on, by function 03.  What came unasked
    /// before is thrown away.
    [[nodiscard]] Answer read(std::uint16_t address, std::size_t count);

    /// Path and line settings.
    [[nodiscard]] const std::string& description() const noexcept { return description_; }

private:
    struct Connection;

    int unit_;
    std::string description_;
    std::unique_ptr<Connection> connection_;
};

}  // namespace a351::daemon
