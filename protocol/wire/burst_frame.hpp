#pragma once
/// @file
/// A burst frame: layout, content, checksum and encoder: protocol/wire/burst-format.md.
///
/// A frame is one sample of the sensor on the line.  BurstLayout says which fields it has; the
/// layout is a setting of the device and is not in the frame itself, so both sides must know it.
/// Use BurstDecoder (burst_decoder.hpp) to get frames out of received bytes, and append_frame() to
/// make the bytes of an emulated device or of a test.  DeviceProfile converts counts to units.
///
///     const auto layout = BurstLayout::from_burst_ctrl(0x4702);  // TEMP, three axes, COUNT
///     std::vector<std::byte> bytes;
///     append_frame(*layout, {.temperature = 2466, .axes = {0, 0, 1 << 24}, .count = 80}, bytes);
///
/// Nothing here keeps state; every function may be called from any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace a351::wire {

/// Axis of the sensor as its data sheet names it.  The value is its index in BurstValues::axes.
enum class Axis : std::uint8_t { x, y, z };

/// First and last byte of every frame; the last one also ends commands and answers.  Nothing is
/// escaped: both are ordinary values inside the fields, so a frame cannot be found by them alone.
inline constexpr std::byte kStartByte{0x80};
inline constexpr std::byte kEndByte{0x0D};
/// Size of the largest frame, bytes: all fields, the layout 0xC703.  The smallest has 6.
inline constexpr std::size_t kLargestFrame = 24;

// BURST_CTRL bits (M-A352AD10 data sheet 7.15).
inline constexpr std::uint16_t kFlagOut = 0x8000;
inline constexpr std::uint16_t kTemperatureOut = 0x4000;
inline constexpr std::uint16_t kXOut = 0x0400;  ///< Y and Z follow, each one bit lower.
inline constexpr std::uint16_t kYOut = 0x0200;
inline constexpr std::uint16_t kZOut = 0x0100;
inline constexpr std::uint16_t kCountOut = 0x0002;
inline constexpr std::uint16_t kChecksumOut = 0x0001;

/// Set of fields in a burst frame, as set in BURST_CTRL (M-A352AD10 data sheet 5.10, 6.2.2):
///
///     0x80 | FLAG 2 | TEMP 4 | X 4 | Y 4 | Z 4 | COUNT 2 | CHKSM 2 | 0x0D
///
/// The order never changes; all fields are big-endian.  112 layouts are valid: any non-empty set
/// of axes, every other field optional.
///
/// Every object is a valid layout: it comes from from_burst_ctrl() or recommended(), and there is
/// no default.  It is a value of 16 bits; copy it freely.  burst_frame_test.cpp compares size and
/// offsets of all layouts with a table made from the data sheet.
///
/// Prefer layouts with COUNT and CHKSM.  Without COUNT lost samples cannot be counted; without
/// CHKSM a flipped bit inside a field is not detected.
class BurstLayout {
public:
    /// Returns the layout that a value of BURST_CTRL selects.
    /// @param value  without reserved bits; mask a value read from a device with
    ///               `kBurstCtrl.defined_bits`, because those bits may read as 1.
    /// @return std::nullopt when no axis is set, or a bit outside FLAG_OUT, TEMP_OUT, ACCX/Y/Z_OUT,
    ///         COUNT_OUT, CHKSM_OUT.
    [[nodiscard]] static std::optional<BurstLayout> from_burst_ctrl(std::uint16_t value) noexcept;

    /// Returns the layout that the daemon records: FLAG, TEMP, three axes, COUNT, CHKSM (0xC703).
    /// The factory setting of the device is another one: 0x4702, without FLAG and CHKSM.
    [[nodiscard]] static BurstLayout recommended() noexcept;

    /// Returns the value of BURST_CTRL that selects this layout; the inverse of from_burst_ctrl().
    [[nodiscard]] std::uint16_t burst_ctrl() const noexcept { return burst_ctrl_; }

    /// Return true if a frame has the field.  At least one axis is always there.
    [[nodiscard]] bool has_flag() const noexcept { return has(kFlagOut); }
    [[nodiscard]] bool has_temperature() const noexcept { return has(kTemperatureOut); }
    [[nodiscard]] bool has_axis(Axis axis) const noexcept {
        return has(static_cast<std::uint16_t>(kXOut >> static_cast<int>(axis)));
    }
    [[nodiscard]] bool has_count() const noexcept { return has(kCountOut); }
    [[nodiscard]] bool has_checksum() const noexcept { return has(kChecksumOut); }

    /// Returns the size of a frame:
    ///
    ///     2 + 2 FLAG + 4 TEMP + 4 (number of axes) + 2 COUNT + 2 CHKSM
    ///
    /// At 8N1 a byte has 10 bits on the line, so the baud rate must be at least 10 x size x output
    /// rate.  24 bytes at 1000 samples/s need 240 000 baud.
    [[nodiscard]] std::size_t frame_size() const noexcept;  ///< In bytes, markers included.

    bool operator==(const BurstLayout&) const = default;

private:
    explicit BurstLayout(std::uint16_t burst_ctrl) noexcept : burst_ctrl_(burst_ctrl) {}
    [[nodiscard]] bool has(std::uint16_t bit) const noexcept { return (burst_ctrl_ & bit) != 0; }
    std::uint16_t burst_ctrl_;
};

/// Fields of a frame as raw counts.  Fields that the layout lacks are zero.
///
/// Zero is also an ordinary value of each field: ask the layout whether a field was there.  The
/// values are not checked for plausibility.  Two values need the attention of every user:
/// - 0x64000000 on an axis: output rate and filter do not fit; the frame has no data.
/// - 0xFFFFFFFF (-1) in temperature and axes: the device has no sample yet.
struct BurstValues {
    /// FLAG: the bits below, and kSigNewDataEnables for new data.  0x8E00 is a frame without errors
    /// if SIG_CTRL has its factory value.
    std::uint16_t flag = 0;
    /// TEMP, counts; DeviceProfile::temperature().  It falls when the temperature rises.
    std::int32_t temperature = 0;
    /// Acceleration, 2^-24 g, or tilt, 2^-29 rad, as SIG_CTRL selects for each axis.
    std::array<std::int32_t, 3> axes{};  ///< Indexed by Axis.
    /// COUNT: conversions at 4000 Hz, modulo 65536, so it wraps every 16.384 s.  Subtract modulo
    /// 65536; timing::SampleIndex makes an index of it that does not wrap.
    std::uint16_t count = 0;

    bool operator==(const BurstValues&) const = default;
};

// FLAG bits (M-A352AD10 data sheet 7.4).
// EA remains until DIAG_STAT, which names the fault, is read; stop sampling to do so.  Discard a
// frame with ALIASI_ERR: it has no data.  X, Y, Z have the alarm bits 4, 3, 2.  Then the value of
// the axis is the limit in its alarm register, 15 g by default.
inline constexpr std::uint16_t kFlagError = 0x0001;     ///< EA: a bit of DIAG_STAT is set.
inline constexpr std::uint16_t kFlagAliasing = 0x0002;  ///< ALIASI_ERR: rate and filter do not fit.
inline constexpr std::uint16_t kFlagAlarms = 0x001C;    ///< X/Y/ZALARM_ERR: output clamped.

/// Frame whose markers and, if the layout has one, checksum were verified.
///
/// Only BurstDecoder can make one (tests/compile_fail/burst_frame_by_hand.cpp).  A function that
/// takes a BurstFrame therefore need not check it again.
class BurstFrame {
public:
    /// Returns the fields; the reference is valid as long as this object.
    [[nodiscard]] const BurstValues& values() const noexcept { return values_; }

private:
    friend class BurstDecoder;
    explicit BurstFrame(const BurstValues& values) noexcept : values_(values) {}
    BurstValues values_;
};

/// Returns the 16-bit word at `offset`, high byte first.
/// @param offset  place of the high byte; offset + 1 < bytes.size(), not checked.
[[nodiscard]] inline std::uint16_t word_at(std::span<const std::byte> bytes,
                                           std::size_t offset) noexcept {
    return static_cast<std::uint16_t>((std::to_integer<unsigned>(bytes[offset]) << 8U) |
                                      std::to_integer<unsigned>(bytes[offset + 1]));
}

/// Returns the sum of the 16-bit big-endian words of `payload`, modulo 65536 (data sheet 6.2.4).
///
/// It detects every single flipped bit, but not swapped words or errors that cancel.  The sum of
/// nothing is 0.  burst_frame_test.cpp reproduces the example of the data sheet.
///
/// @param payload  the bytes between the start byte and the checksum; an even number.
[[nodiscard]] std::uint16_t burst_checksum(std::span<const std::byte> payload) noexcept;

/// Appends the frame that carries `values` in `layout`.
///
/// Exactly layout.frame_size() bytes are appended, markers and checksum included.  Values of fields
/// that the layout lacks are ignored, so a decoder returns them as zero.  All others are decoded to
/// the same values, for every layout (burst_decoder_test.cpp).
///
/// @param out  is not cleared; it allocates only if its capacity is too small.
void append_frame(const BurstLayout& layout, const BurstValues& values,
                  std::vector<std::byte>& out);

}  // namespace a351::wire
