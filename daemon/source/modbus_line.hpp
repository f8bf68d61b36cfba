#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::daemon::source {

/// Reads registers of one unit over Modbus RTU with libmodbus, on a port that it keeps locked.
/// It has no function that writes a register.
class ModbusLine {
public:
    struct Settings {
        std::filesystem::path port = {};  ///< Device, pseudo-terminal, or a link to one.
        int baud = 9600;                  ///< A rate that libmodbus knows; any other becomes 9600.
        char parity = 'E';                ///< E, O or N.
        int unit = 1;                     ///< 1 ... 99.
        bool is_rs485 = false;  ///< The kernel's driver switches the direction (TIOCSRS485).
    };
    struct Answer {
        journal::OvenOutcome outcome = journal::OvenOutcome::no_port;
        std::vector<std::uint16_t> words;  ///< Values, as many as requested; none if not answered.
        std::string trouble;               ///< Reason why there is no answer, in words.
        std::uint8_t exception = 0;        ///< Code of the exception, if that is the outcome.
    };

    /// Longest time of one read.
    static constexpr std::chrono::milliseconds kResponseTimeout{300};

    /// Resolves links, then locks, opens and sets up the port.
    /// @throws PortError
    explicit ModbusLine(const Settings& settings);
    ~ModbusLine();

    /// Reads `count` registers (1 ... 125) from `address` on with function 03.  Bytes received
    /// before the request are discarded.
    [[nodiscard]] Answer read(std::uint16_t address, std::size_t count);

    /// Returns path and line settings in one line.
    [[nodiscard]] const std::string& description() const noexcept { return description_; }

private:
    struct Connection;

    int unit_;
    std::string description_;
    std::unique_ptr<Connection> connection_;
};

}  // namespace a351::daemon::source
