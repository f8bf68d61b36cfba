#pragma once
/// @file
/// Register map as data.  Seiko Epson, M-A352AD10 data sheet, rev. 20251023, table 7.1 and
/// sections 7.1-7.30; W0:4C is only in the maker's public Python driver (py_esensorlib).
///
/// The commands that read and write these registers are in commands.hpp.  Section numbers below are
/// those of the data sheet.  Everything is constant and initialised at compile time, so it may be
/// used from any thread and before main().  No public document of the M-A351 is known; its map is
/// assumed to be the same.

#include <array>
#include <cstdint>
#include <string_view>

namespace a351::wire {

/// Bank of registers, selected by WIN_CTRL.  The same address has another meaning in each window.
/// After a reset the device is in window 0; a new connection may find either.
enum class Window : std::uint8_t { w0 = 0, w1 = 1 };

/// 16-bit register: low byte at the even `address`, high byte at the next one.
///
/// A read returns both bytes; a write sets one byte.  A default-constructed value is no register of
/// the device: take registers from the constants below or from register_at().
struct Register {
    Window window = Window::w0;
    /// Address of the low byte: even, 0x00 ... 0x7E.
    std::uint8_t address = 0;
    /// Name in the data sheet, such as "MODE_CTRL".  Not unique: WIN_CTRL is in both windows.
    std::string_view name;
    std::uint16_t default_value = 0;   ///< After reset with factory flash; 0 if devices differ.
    std::uint16_t defined_bits = 0;    ///< The others are reserved: write 0, ignore when read.
    std::uint16_t writable_bytes = 0;  ///< 0x00FF low byte, 0xFF00 high byte.
    /// True if the flash holds the value.  Then default_value is that of a device whose flash
    /// was never changed: read the register instead of relying on it.
    bool is_saved_in_flash = false;
};

/// Masks of a register's bytes, for Register::writable_bytes and the mask of ConfigMode::write().
inline constexpr std::uint16_t kLowByte = 0x00FF;
inline constexpr std::uint16_t kHighByte = 0xFF00;
inline constexpr std::uint16_t kBothBytes = 0xFFFF;

/// All registers, in order of window and address.  WIN_CTRL is the same register in both windows.
///
/// Window 0, state and data:
/// - BURST: a write of 0 to the low byte requests one frame, if frames are not sent unasked.
/// - MODE_CTRL: mode of the device, and commands that change it (7.2).
/// - DIAG_STAT: faults (7.3).  A read clears it, and with it the bit EA of FLAG.
/// - FLAG: new data, alarms and errors (7.4).  A read clears the alarms.
/// - COUNT: conversions at 4000 Hz, modulo 65536 (7.5).
/// - TEMP, XACCL ... ZACCL, XTILT ... ZTILT: 32-bit counts in two's complement, word HIGH at the
///   lower address (7.6-7.8).  A tilt is valid only if SIG_CTRL selects it for its axis.
/// - ID: 0x5345, the characters E and S.  Not every device of the family must have it.
///
/// Window 1, settings:
/// - SIG_CTRL: new-data bits, acceleration or tilt, noise mode, thermal stabilisation (7.9).
/// - MSC_CTRL: self tests in the high byte, pins EXT and DRDY in the low byte (7.10).
/// - SMPL_CTRL: code of the output rate (7.11).  FILTER_CTRL: code of the filter (7.12).
/// - UART_CTRL: code of the baud rate, start after power-on, frames unasked (7.13).
/// - GLOB_CMD: reset and flash commands, state of start-up (7.14).
/// - BURST_CTRL: fields of a frame; BurstLayout reads and makes its value (7.15).
/// - FIR_UCMD, FIR_UDATA, FIR_UADDR: coefficients of the user filter, byte by byte (7.16-7.18).
/// - LONGFILT_CTRL, LONGFILT_TAP: filter at the output rate, off by default (7.19, 7.20).
/// - OFFSET_XA ... OFFSET_ZA: added to the output, in counts of acceleration.
/// - XALARM ... ZALARM: limits of the output in g, signed; upper one in the high byte.
/// - PROD_ID, SERIAL_NUM: eight characters each; the low byte of a word is the earlier one (7.27).
/// - VERSION: firmware, a number without a documented structure.
///
/// Window and address are unique together; commands_test.cpp compares the writable bytes with
/// table 7.1.
inline constexpr std::array kRegisters{
    Register{Window::w0, 0x00, "BURST", 0xFFFF, 0x00FF, kLowByte, false},
    Register{Window::w0, 0x02, "MODE_CTRL", 0x0400, 0x0F00, kHighByte, false},
    Register{Window::w0, 0x04, "DIAG_STAT", 0x0000, 0xFFFF, 0, false},
    Register{Window::w0, 0x06, "FLAG", 0x0000, 0x8E1F, 0, false},
    Register{Window::w0, 0x0A, "COUNT", 0x0000, 0xFFFF, 0, false},
    Register{Window::w0, 0x0E, "TEMP_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x10, "TEMP_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x30, "XACCL_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x32, "XACCL_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x34, "YACCL_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x36, "YACCL_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x38, "ZACCL_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x3A, "ZACCL_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x3C, "XTILT_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x3E, "XTILT_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x40, "YTILT_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x42, "YTILT_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x44, "ZTILT_HIGH", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x46, "ZTILT_LOW", 0xFFFF, 0xFFFF, 0, false},
    Register{Window::w0, 0x4C, "ID", 0x5345, 0xFFFF, 0, false},
    Register{Window::w0, 0x7E, "WIN_CTRL", 0x0000, 0x00FF, kLowByte, false},
    Register{Window::w1, 0x00, "SIG_CTRL", 0x8E04, 0x8EF4, kBothBytes, true},
    Register{Window::w1, 0x02, "MSC_CTRL", 0x0026, 0x7F66, kBothBytes, true},
    Register{Window::w1, 0x04, "SMPL_CTRL", 0x0400, 0x0F00, kHighByte, true},
    Register{Window::w1, 0x06, "FILTER_CTRL", 0x0008, 0x002F, kLowByte, true},
    Register{Window::w1, 0x08, "UART_CTRL", 0x0100, 0x0303, kBothBytes, true},
    Register{Window::w1, 0x0A, "GLOB_CMD", 0x0000, 0x148C, kLowByte, false},
    Register{Window::w1, 0x0C, "BURST_CTRL", 0x4702, 0xC703, kBothBytes, true},
    Register{Window::w1, 0x16, "FIR_UCMD", 0x0000, 0x0003, kLowByte, false},
    Register{Window::w1, 0x18, "FIR_UDATA", 0x0000, 0x80FF, kLowByte, false},
    Register{Window::w1, 0x1A, "FIR_UADDR", 0x0800, 0x0FFF, kBothBytes, false},
    Register{Window::w1, 0x1C, "LONGFILT_CTRL", 0x0000, 0x0003, kLowByte, true},
    Register{Window::w1, 0x1E, "LONGFILT_TAP", 0x000A, 0x000F, kLowByte, true},
    Register{Window::w1, 0x2C, "OFFSET_XA_HIGH", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x2E, "OFFSET_XA_LOW", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x30, "OFFSET_YA_HIGH", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x32, "OFFSET_YA_LOW", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x34, "OFFSET_ZA_HIGH", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x36, "OFFSET_ZA_LOW", 0x0000, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x46, "XALARM", 0x0FF1, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x48, "YALARM", 0x0FF1, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x4A, "ZALARM", 0x0FF1, 0xFFFF, kBothBytes, true},
    Register{Window::w1, 0x6A, "PROD_ID1", 0x3341, 0xFFFF, 0, false},
    Register{Window::w1, 0x6C, "PROD_ID2", 0x3235, 0xFFFF, 0, false},
    Register{Window::w1, 0x6E, "PROD_ID3", 0x4441, 0xFFFF, 0, false},
    Register{Window::w1, 0x70, "PROD_ID4", 0x3031, 0xFFFF, 0, false},
    Register{Window::w1, 0x72, "VERSION", 0x0000, 0xFFFF, 0, false},
    Register{Window::w1, 0x74, "SERIAL_NUM1", 0x0000, 0xFFFF, 0, false},
    Register{Window::w1, 0x76, "SERIAL_NUM2", 0x0000, 0xFFFF, 0, false},
    Register{Window::w1, 0x78, "SERIAL_NUM3", 0x0000, 0xFFFF, 0, false},
    Register{Window::w1, 0x7A, "SERIAL_NUM4", 0x0000, 0xFFFF, 0, false},
    Register{Window::w1, 0x7E, "WIN_CTRL", 0x0000, 0x00FF, kLowByte, false},
};

/// Returns the register at an even address, or null.
///
/// Null is also the result for an odd address and for an address without a register.  The result
/// points into kRegisters, so it may be compared by address and is valid for the whole run.  The
/// search is linear.
/// @param address  even address; no write bit.
[[nodiscard]] constexpr const Register* register_at(Window window, std::uint8_t address) noexcept {
    for (const Register& candidate : kRegisters) {
        if (candidate.window == window && candidate.address == address) return &candidate;
    }
    return nullptr;
}

/// Returns the register at an even address; does not compile if there is none.  Use it to name
/// further registers as constants; for an address known at run time only, use register_at().
[[nodiscard]] consteval const Register& require_register(Window window, std::uint8_t address) {
    return *register_at(window, address);
}

/// Registers that this project uses by name.  They refer to elements of kRegisters.
inline constexpr const Register& kModeCtrl = require_register(Window::w0, 0x02);
inline constexpr const Register& kDiagStat = require_register(Window::w0, 0x04);
inline constexpr const Register& kFlag = require_register(Window::w0, 0x06);
inline constexpr const Register& kId = require_register(Window::w0, 0x4C);
inline constexpr const Register& kWinCtrl = require_register(Window::w0, 0x7E);
inline constexpr const Register& kSigCtrl = require_register(Window::w1, 0x00);
inline constexpr const Register& kMscCtrl = require_register(Window::w1, 0x02);
inline constexpr const Register& kSmplCtrl = require_register(Window::w1, 0x04);
inline constexpr const Register& kFilterCtrl = require_register(Window::w1, 0x06);
inline constexpr const Register& kUartCtrl = require_register(Window::w1, 0x08);
inline constexpr const Register& kGlobCmd = require_register(Window::w1, 0x0A);
inline constexpr const Register& kBurstCtrl = require_register(Window::w1, 0x0C);

// All constants below are bits or fields of a 16-bit register, at their place in it.

// MODE_CTRL (7.2): state of the device, and the commands that change it.
/// Mask of the present mode, MODE_STAT: 0x0000 sampling, kModeStatConfig, 0x0800 sleep.  Read only.
inline constexpr std::uint16_t kModeStat = 0x0C00;
/// MODE_STAT in configuration mode, the only mode in which settings can be written.
inline constexpr std::uint16_t kModeStatConfig = 0x0400;
/// Commands, MODE_CMD, to be written to the high byte.  The device clears them when it has obeyed.
/// It leaves sleep only by an edge at its pin EXT, because its UART sleeps too.
inline constexpr std::uint16_t kModeCmdSampling = 0x0100;
inline constexpr std::uint16_t kModeCmdConfig = 0x0200;
inline constexpr std::uint16_t kModeCmdSleep = 0x0300;

// DIAG_STAT (7.3).
/// HARD_ERR: the check of the hardware at start-up failed if any of these bits is set.  The sensor
/// is faulty; do not use its data.
inline constexpr std::uint16_t kDiagHardError = 0x00E0;
/// UART_OVF: frames are made faster than the baud rate can carry them; expect losses.  Use a
/// higher baud rate, a lower output rate or a shorter layout.
inline constexpr std::uint16_t kDiagUartOverflow = 0x0008;
/// FLASH_ERR: the flash failed its test, or could not be read at start-up.  The sensor may lack its
/// calibration; do not use its data.
inline constexpr std::uint16_t kDiagFlashError = 0x0004;

// SIG_CTRL (7.9), MSC_CTRL (7.10), FILTER_CTRL (7.12), UART_CTRL (7.13), GLOB_CMD (7.14).
/// ND_EN: FLAG reports new data of temperature, X, Y, Z.  FLAG has these bits at the same places.
inline constexpr std::uint16_t kSigNewDataEnables = 0x8E00;
/// OUTPUT_SEL of X, Y, Z: a set bit makes the axis send its tilt instead of its acceleration.
inline constexpr std::uint16_t kSigTiltSelects = 0x00E0;
/// EXT_SEL: samples are taken at edges of the pin EXT, not by the internal timer.
inline constexpr std::uint16_t kMscExternalTrigger = 0x0040;
inline constexpr std::uint16_t kMscDataReady = 0x0006;  ///< DRDY_ON, DRDY_POL.
/// FILTER_STAT, read only: a filter is being set, which takes 4 ms, or 100 ms for a user filter.
inline constexpr std::uint16_t kFilterBusy = 0x0020;
/// FILTER_SEL: code of the filter, FilterSpec::code.
inline constexpr std::uint16_t kFilterSelect = 0x000F;
/// AUTO_START: sampling begins after power-on without a command, if UART_AUTO is set too and both
/// are in the flash.
inline constexpr std::uint16_t kUartAutoStart = 0x0002;
/// UART_AUTO: in sampling mode each sample is sent as a frame.  If it is clear, a write to BURST
/// requests each frame.
inline constexpr std::uint16_t kUartAuto = 0x0001;
/// NOT_READY, read only: the device is starting up; wait until it is clear.  Start-up takes up to
/// 0.9 s after power-on and 0.97 s after a reset.
inline constexpr std::uint16_t kGlobNotReady = 0x0400;
/// Commands of GLOB_CMD.  Each bit reads 1 until the command has ended.  SOFT_RST restarts the
/// device; settings that are not in the flash are lost.
inline constexpr std::uint16_t kGlobSoftReset = 0x0080;
/// FLASH_BACKUP: writes the settings to the flash.  Each backup wears the flash out a little.
inline constexpr std::uint16_t kGlobFlashBackup = 0x0008;
/// FLASH_RST: restores the factory settings in the flash.  They take effect after the next reset.
inline constexpr std::uint16_t kGlobFlashReset = 0x0004;

}  // namespace a351::wire
