#include "daemon/source/modbus_line.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <modbus/modbus.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <system_error>

#include "daemon/source/port.hpp"

namespace a351::daemon::source {
namespace {

using journal::OvenOutcome;

constexpr std::uint8_t kReadRegisters = 0x03;
constexpr std::uint8_t kException = 0x80;
// Bytes besides the values: unit, function, byte count and CRC.  An exception frame has as many.
constexpr std::size_t kFrameOverhead = 5;

using Frame = std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH>;

/// Checks the CRC of Modbus over Serial Line V1.02, section 2.5.1.2.  Computed over a frame with
/// its own CRC it is 0.
bool is_sealed(const Frame& frame, std::size_t size) {
    boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true> crc;
    crc.process_bytes(frame.data(), size);
    return crc.checksum() == 0;
}

// libmodbus checks the CRC only if the unit is right, and would report noise as the answer of
// another unit.
ModbusLine::Answer answer_of_others(const Frame& frame) {
    const std::size_t size = kFrameOverhead + (frame[1] == kReadRegisters ? frame[2] : 0U);
    if (size > frame.size() || !is_sealed(frame, size)) {
        return {OvenOutcome::bad_crc, {}, "bytes that are not a frame"};
    }
    return {OvenOutcome::other_unit, {}, fmt::format("unit {} answered", frame[0])};
}

ModbusLine::Answer answer_in(const Frame& frame, std::size_t size, std::size_t count) {
    if (size == kFrameOverhead && frame[1] == (kReadRegisters | kException)) {
        return {OvenOutcome::exception, {}, fmt::format("exception {}", frame[2]), frame[2]};
    }
    if (frame[1] != kReadRegisters || size != kFrameOverhead + 2 * count || frame[2] != 2 * count) {
        return {OvenOutcome::malformed, {}, "the answer does not match the request"};
    }
    ModbusLine::Answer answer{OvenOutcome::answered, {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        answer.words.push_back(
            static_cast<std::uint16_t>(frame.at(3 + 2 * i) << 8 | frame.at(4 + 2 * i)));
    }
    return answer;
}

tcflag_t parity_bits(char parity) {
    return parity == 'N' ? 0U : parity == 'O' ? PARENB | PARODD : PARENB;
}

ModbusLine::Answer failure(int error) {
    if (error == ETIMEDOUT) return {OvenOutcome::timed_out, {}, "no answer in time"};
    if (error == EMBBADCRC) return {OvenOutcome::bad_crc, {}, "wrong CRC"};
    // The stated length exceeds that of the longest frame.
    if (error == EMBBADDATA) return {OvenOutcome::bad_crc, {}, "bytes that are not a frame"};
    return {OvenOutcome::no_port, {}, std::generic_category().message(error)};
}

}  // namespace

struct ModbusLine::Connection {
    int lock = -1;
    modbus_t* context = nullptr;

    ~Connection() {
        if (context != nullptr) {
            modbus_close(context);
            modbus_free(context);
        }
        if (lock >= 0) close(lock);
    }
};

ModbusLine::ModbusLine(const Settings& settings)
    : unit_(settings.unit), connection_(std::make_unique<Connection>()) {
    using Kind = PortError::Kind;
    std::error_code error;
    const auto device = std::filesystem::canonical(settings.port, error);
    if (error) throw PortError(Kind::absent, settings.port, error.message());
    // Manuals specify two stop bits without parity.  A controller set to one stop bit understands
    // two as well, because a receiver checks only the first.
    const int stop_bits = settings.parity == 'N' ? 2 : 1;
    description_ = fmt::format("{}, {} baud 8{}{}", device.string(), settings.baud, settings.parity,
                               stop_bits);

    // libmodbus opens the path itself; the lock must be held before it changes the settings.
    connection_->lock = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (connection_->lock < 0) {
        throw PortError(errno == EBUSY ? Kind::locked : Kind::absent, device,
                        std::generic_category().message(errno));
    }
    if (isatty(connection_->lock) == 0)
        throw PortError(Kind::settings, device, "not a serial port");
    if (flock(connection_->lock, LOCK_EX | LOCK_NB) != 0)
        throw PortError(Kind::locked, device, "in use by another process");
    // libmodbus restores the settings that it found.  A port with echo on would send data to the
    // controller while nobody reads.
    termios raw{};
    if (tcgetattr(connection_->lock, &raw) == 0) {
        cfmakeraw(&raw);
        tcsetattr(connection_->lock, TCSANOW, &raw);
    }
    connection_->context =
        modbus_new_rtu(device.c_str(), settings.baud, settings.parity, 8, stop_bits);
    if (connection_->context == nullptr || modbus_connect(connection_->context) != 0)
        throw PortError(Kind::settings, description_, std::generic_category().message(errno));
    termios kept{};
    if (tcgetattr(connection_->lock, &kept) != 0 ||
        (kept.c_cflag & (PARENB | PARODD)) != parity_bits(settings.parity)) {
        throw PortError(Kind::settings, description_,
                        "the port does not keep this parity; use another parity or port");
    }
    if (settings.is_rs485 &&
        modbus_rtu_set_serial_mode(connection_->context, MODBUS_RTU_RS485) != 0) {
        throw PortError(Kind::settings, description_,
                        "the port's driver cannot switch an RS-485 line; set rs485 = false");
    }
    modbus_set_slave(connection_->context, settings.unit);
    using std::chrono::microseconds;
    modbus_set_response_timeout(connection_->context, 0,
                                static_cast<std::uint32_t>(microseconds(kResponseTimeout).count()));
    // Without a time-out per byte, the response time-out applies to the whole answer.
    modbus_set_byte_timeout(connection_->context, 0, 0);
}

ModbusLine::~ModbusLine() = default;

ModbusLine::Answer ModbusLine::read(std::uint16_t address, std::size_t count) {
    modbus_t* const context = connection_->context;
    const std::array<std::uint8_t, 6> request{static_cast<std::uint8_t>(unit_),
                                              kReadRegisters,
                                              static_cast<std::uint8_t>(address >> 8),
                                              static_cast<std::uint8_t>(address & 0xFF),
                                              0,
                                              static_cast<std::uint8_t>(count)};
    modbus_flush(context);
    Frame frame{};
    if (modbus_send_raw_request(context, request.data(), request.size()) < 0) return failure(errno);
    const int size = modbus_receive_confirmation(context, frame.data());
    if (size < 0) return failure(errno);
    if (frame[0] != unit_) return answer_of_others(frame);
    return answer_in(frame, static_cast<std::size_t>(size), count);
}

}  // namespace a351::daemon::source
