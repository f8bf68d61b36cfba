#pragma once
/// @file
/// Content of a burst frame, its checksum and its encoder: protocol/wire/burst-format.md.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/wire/burst_layout.hpp"

namespace a351::wire {

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

/// Returns the sum of the 16-bit big-endian words of `payload`, modulo 65536 (data sheet 6.2.4).
/// @param payload  the bytes between the start byte and the checksum; an even number.
[[nodiscard]] std::uint16_t burst_checksum(std::span<const std::byte> payload) noexcept;

/// Appends the frame that carries `values` in `layout`.
void append_frame(const BurstLayout& layout, const BurstValues& values,
                  std::vector<std::byte>& out);

}  // namespace a351::wire
