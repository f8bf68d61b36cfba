#include "sim/truth/truth_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "protocol/core/input_error.hpp"

namespace a351::sim::truth {
namespace {

constexpr std::string_view kMagic = "A351TRU2";
constexpr std::size_t kHeaderSize = 16;
constexpr std::size_t kRecordSize = 40;

template <class Integer>
void put(char*& at, Integer value) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (std::size_t i = 0; i < sizeof(Integer); ++i)
        *at++ = static_cast<char>((bits >> (8 * i)) & 0xFFU);
}

}  // namespace

void Writer::require_own(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return;
    std::ifstream in(file, std::ios::binary);
    std::array<char, kMagic.size()> begin{};
    in.read(begin.data(), begin.size());
    const std::string_view found(begin.data(), static_cast<std::size_t>(in.gcount()));
    if (!found.empty() && found != kMagic) {
        throw InputError(file.string() +
                         ": exists and is no truth file; allowed: a new path, or a truth file");
    }
}

Writer::Writer(std::filesystem::path file)
    : path_((require_own(file), std::move(file))), out_(path_, std::ios::binary | std::ios::trunc) {
    std::array<char, kHeaderSize> header{};
    std::memcpy(header.data(), kMagic.data(), kMagic.size());
    char* at = header.data() + kMagic.size();
    put(at, static_cast<std::uint32_t>(kRecordSize));
    out_.write(header.data(), header.size());
    require_good();
}

void Writer::require_good() const {
    if (!out_) throw std::system_error(errno, std::generic_category(), path_.string());
}

void Writer::append(const Record& record) {
    std::array<char, kRecordSize> bytes{};
    char* at = bytes.data();
    put(at, static_cast<std::int64_t>(record.utc.time_since_epoch().count()));
    for (const std::int32_t axis : record.values.axes) put(at, axis);
    put(at, record.values.temperature);
    put(at, record.values.count);
    put(at, record.sampling_run);
    put(at, record.grid_index);
    put(at, static_cast<std::uint8_t>(record.fate));
    out_.write(bytes.data(), bytes.size());
    require_good();
}

void Writer::close() {
    out_.close();
    require_good();
}

}  // namespace a351::sim::truth
