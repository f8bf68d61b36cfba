#pragma once
/// @file
/// Little-endian integers to and from bytes, on any host.  Used by the codecs of chunks.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace a351::journal {

/// Appends an integer: sizeof(Int) bytes, the lowest first.
template <class Int>
void put(std::vector<std::byte>& out, std::type_identity_t<Int> value) {
    using Bits = std::make_unsigned_t<Int>;
    const auto bits = static_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(Int); ++i)
        out.push_back(static_cast<std::byte>(bits >> (8 * i) & 0xFFU));
}

/// Appends the bytes of a text, without a length.
inline void put(std::vector<std::byte>& out, std::string_view text) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    out.insert(out.end(), bytes, bytes + text.size());
}

/// Overwrites the first sizeof(Int) bytes of `out`.
/// @tparam Int  an unsigned integer.
template <class Int>
void put_at(std::span<std::byte> out, std::type_identity_t<Int> value) {
    for (std::size_t i = 0; i < sizeof(Int); ++i)
        out[i] = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
}

/// Takes fields from the front of some bytes.  After one that is missing or refused, all further
/// ones are missing too, and integers are 0.
///
///     Fields fields(payload);
///     const auto count = fields.take<std::uint32_t>();
///     if (!fields.is_used_up()) return std::nullopt;  // something missing, refused or left
class Fields {
public:
    explicit Fields(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class Int>
    Int take() {
        using Bits = std::make_unsigned_t<Int>;
        Bits bits = 0;
        const auto field = take_bytes(sizeof(Int));
        for (std::size_t i = 0; i < field.size(); ++i) {
            bits = static_cast<Bits>(
                bits | static_cast<Bits>(Bits(std::to_integer<std::uint8_t>(field[i])) << (8 * i)));
        }
        return static_cast<Int>(bits);
    }

    /// Takes so many bytes; none if there are fewer.
    std::span<const std::byte> take_bytes(std::size_t count) {
        if (count > bytes_.size()) {
            refuse();
            return {};
        }
        const auto front = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return front;
    }

    /// Makes this field and all further ones count as missing: its value is out of range.
    void refuse() {
        is_short_ = true;
        bytes_ = {};
    }

    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size(); }
    /// Returns true if a field was missing or refused.
    [[nodiscard]] bool is_short() const noexcept { return is_short_; }
    /// Returns true if no field was missing or refused, and no byte is left.
    [[nodiscard]] bool is_used_up() const noexcept { return !is_short_ && bytes_.empty(); }

private:
    std::span<const std::byte> bytes_;
    bool is_short_ = false;
};

}  // namespace a351::journal
