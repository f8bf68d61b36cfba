#pragma once
/// @file
/// Register map as data.  Seiko Epson, M-A352AD10 data sheet, rev. 20251023, table 7.1 and
/// sections 7.1-7.30; W0:4C is only in the maker's public Python driver (py_esensorlib).

#include <array>
#include <cstdint>
#include <string_view>

namespace a351::wire {

enum class Window : std::uint8_t { w0 = 0, w1 = 1 };

/// 16-bit register: low byte at the even `address`, high byte at the next one.
struct Register {
    Window window = Window::w0;
    std::uint8_t address = 0;
    std::string_view name;
    std::uint16_t default_value = 0;   ///< After reset with factory flash; 0 if devices differ.
    std::uint16_t defined_bits = 0;    ///< The others are reserved: write 0, ignore when read.
    std::uint16_t writable_bytes = 0;  ///< 0x00FF low byte, 0xFF00 high byte.
    bool is_saved_in_flash = false;
};

inline constexpr std::uint16_t kLowByte = 0x00FF;
inline constexpr std::uint16_t kHighByte = 0xFF00;
inline constexpr std::uint16_t kBothBytes = 0xFFFF;

/// All registers, in order of window and address.  WIN_CTRL is the same register in both windows.
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
[[nodiscard]] constexpr const Register* register_at(Window window, std::uint8_t address) noexcept {
    for (const Register& candidate : kRegisters) {
        if (candidate.window == window && candidate.address == address) return &candidate;
    }
    return nullptr;
}

/// Returns the register at an even address; does not compile if there is none.
[[nodiscard]] consteval const Register& require_register(Window window, std::uint8_t address) {
    return *register_at(window, address);
}

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

// MODE_CTRL (7.2): state of the device, and the commands that change it.
inline constexpr std::uint16_t kModeStat = 0x0C00;
inline constexpr std::uint16_t kModeStatConfig = 0x0400;
inline constexpr std::uint16_t kModeCmdSampling = 0x0100;
inline constexpr std::uint16_t kModeCmdConfig = 0x0200;
inline constexpr std::uint16_t kModeCmdSleep = 0x0300;

// DIAG_STAT (7.3).
inline constexpr std::uint16_t kDiagHardError = 0x00E0;
inline constexpr std::uint16_t kDiagUartOverflow = 0x0008;
inline constexpr std::uint16_t kDiagFlashError = 0x0004;

// SIG_CTRL (7.9), MSC_CTRL (7.10), FILTER_CTRL (7.12), UART_CTRL (7.13), GLOB_CMD (7.14).
inline constexpr std::uint16_t kSigNewDataEnables = 0x8E00;
inline constexpr std::uint16_t kSigTiltSelects = 0x00E0;
inline constexpr std::uint16_t kMscExternalTrigger = 0x0040;
inline constexpr std::uint16_t kMscDataReady = 0x0006;  ///< DRDY_ON, DRDY_POL.
inline constexpr std::uint16_t kFilterBusy = 0x0020;
inline constexpr std::uint16_t kFilterSelect = 0x000F;
inline constexpr std::uint16_t kUartAutoStart = 0x0002;
inline constexpr std::uint16_t kUartAuto = 0x0001;
inline constexpr std::uint16_t kGlobNotReady = 0x0400;
inline constexpr std::uint16_t kGlobSoftReset = 0x0080;
inline constexpr std::uint16_t kGlobFlashBackup = 0x0008;
inline constexpr std::uint16_t kGlobFlashReset = 0x0004;

}  // namespace a351::wire
