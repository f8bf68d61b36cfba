#pragma once
/// @file
/// A burst frame: layout, content, checksum and encoder: protocol/wire/burst-format.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace a351::wire {

enum class Axis : std::uint8_t { x, y, z };

inline constexpr std::byte kStartByte{0x80};
inline constexpr std::byte kEndByte{0x0D};
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
class BurstLayout {
public:
    /// Returns the layout that a value of BURST_CTRL selects.
    /// @return std::nullopt when no axis is set, or a bit outside FLAG_OUT, TEMP_OUT, ACCX/Y/Z_OUT,
    ///         COUNT_OUT, CHKSM_OUT.
    [[nodiscard]] static std::optional<BurstLayout> from_burst_ctrl(std::uint16_t value) noexcept;

    /// Returns the layout that the daemon records: FLAG, TEMP, three axes, COUNT, CHKSM (0xC703).
    [[nodiscard]] static BurstLayout recommended() noexcept;

    [[nodiscard]] std::uint16_t burst_ctrl() const noexcept { return burst_ctrl_; }
    [[nodiscard]] bool has_flag() const noexcept { return has(kFlagOut); }
    [[nodiscard]] bool has_temperature() const noexcept { return has(kTemperatureOut); }
    [[nodiscard]] bool has_axis(Axis axis) const noexcept {
        return has(static_cast<std::uint16_t>(kXOut >> static_cast<int>(axis)));
    }
    [[nodiscard]] bool has_count() const noexcept { return has(kCountOut); }
    [[nodiscard]] bool has_checksum() const noexcept { return has(kChecksumOut); }

    [[nodiscard]] std::size_t frame_size() const noexcept;  ///< In bytes, markers included.

    bool operator==(const BurstLayout&) const = default;

private:
    explicit BurstLayout(std::uint16_t burst_ctrl) noexcept : burst_ctrl_(burst_ctrl) {}
    [[nodiscard]] bool has(std::uint16_t bit) const noexcept { return (burst_ctrl_ & bit) != 0; }
    std::uint16_t burst_ctrl_;
};

/// Fields of a frame as raw counts.  Fields that the layout lacks are zero.
struct BurstValues {
    std::uint16_t flag = 0;
    std::int32_t temperature = 0;
    std::array<std::int32_t, 3> axes{};  ///< Indexed by Axis.
    std::uint16_t count = 0;

    bool operator==(const BurstValues&) const = default;
};

// FLAG bits (M-A352AD10 data sheet 7.4).
inline constexpr std::uint16_t kFlagError = 0x0001;     ///< EA: a bit of DIAG_STAT is set.
inline constexpr std::uint16_t kFlagAliasing = 0x0002;  ///< ALIASI_ERR: rate and filter do not fit.
inline constexpr std::uint16_t kFlagAlarms = 0x001C;    ///< X/Y/ZALARM_ERR: output clamped.

/// Frame whose markers and, if the layout has one, checksum were verified.
class BurstFrame {
public:
    [[nodiscard]] const BurstValues& values() const noexcept { return values_; }

private:
    friend class BurstDecoder;
    explicit BurstFrame(const BurstValues& values) noexcept : values_(values) {}
    BurstValues values_;
};

/// Returns the 16-bit word at `offset`, high byte first.
[[nodiscard]] inline std::uint16_t word_at(std::span<const std::byte> bytes,
                                           std::size_t offset) noexcept {
    return static_cast<std::uint16_t>((std::to_integer<unsigned>(bytes[offset]) << 8U) |
                                      std::to_integer<unsigned>(bytes[offset + 1]));
}

/// Returns the sum of the 16-bit big-endian words of `payload`, modulo 65536 (data sheet 6.2.4).
/// @param payload  the bytes between the start byte and the checksum; an even number.
[[nodiscard]] std::uint16_t burst_checksum(std::span<const std::byte> payload) noexcept;

/// Appends the frame that carries `values` in `layout`.
void append_frame(const BurstLayout& layout, const BurstValues& values,
                  std::vector<std::byte>& out);

}  // namespace a351::wire
