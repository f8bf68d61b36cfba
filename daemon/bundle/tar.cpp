#include "daemon/bundle/tar.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace a351::daemon::bundle {
namespace {

// Place and length of the fields.
constexpr std::size_t kName = 100;
constexpr std::size_t kSizeAt = 124, kTimeAt = 136, kNumber = 12;
constexpr std::size_t kSumAt = 148;
constexpr std::string_view kBlanks = "        ";
constexpr std::size_t kTypeAt = 156, kMagicAt = 257;
constexpr std::string_view kMagic{"ustar\00000", 8};
constexpr std::uint64_t kLargest = (std::uint64_t{1} << 33U) - 1;  // Eleven octal digits.

/// Returns the sum of the bytes of a header.
unsigned checksum(std::string_view block) {
    return std::accumulate(block.begin(), block.end(), 0U, [](unsigned total, char byte) {
        return total + static_cast<unsigned char>(byte);
    });
}

/// Reads octal digits that end at a zero.
std::optional<std::uint64_t> octal(std::string_view digits) {
    std::uint64_t value = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, 8);
    const bool is_good = error == std::errc{} && end == digits.data() + digits.size() - 1;
    return is_good ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string tar_header(const TarFile& file) {
    if (file.name.size() > kName || file.size > kLargest)
        throw std::invalid_argument(file.name + ": name or size is too large for a tar file");
    std::string block(kTarBlock, '\0');
    const auto put = [&](std::size_t at, std::string_view text) {
        std::ranges::copy(text, block.begin() + static_cast<std::ptrdiff_t>(at));
    };
    put(0, file.name);
    put(kName, "0000644");  // mode
    put(108, "0000000");    // user
    put(116, "0000000");    // group
    put(kSizeAt, fmt::format("{:011o}", file.size));
    put(kTimeAt,
        fmt::format("{:011o}", std::max<std::int64_t>(0, file.time.time_since_epoch().count())));
    put(kTypeAt, "0");
    put(kMagicAt, kMagic);
    put(329, "0000000");   // device, major
    put(337, "0000000");   // device, minor
    put(kSumAt, kBlanks);  // The sum counts its own field as blanks.
    put(kSumAt, fmt::format("{:06o}", checksum(block)) + '\0');
    return block;
}

std::optional<TarFile> parse_tar_header(std::string_view block) {
    if (block.size() != kTarBlock) return std::nullopt;
    const auto size = octal(block.substr(kSizeAt, kNumber));
    const auto time = octal(block.substr(kTimeAt, kNumber));
    if (!size || !time) return std::nullopt;
    const std::string_view name = block.substr(0, kName);
    TarFile file{std::string(name.substr(0, name.find('\0'))), *size,
                 std::chrono::sys_seconds(std::chrono::seconds(*time))};
    return tar_header(file) == block ? std::optional(std::move(file)) : std::nullopt;
}

}  // namespace a351::daemon::bundle
