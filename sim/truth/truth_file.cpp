#include "sim/truth/truth_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::sim {
namespace {

constexpr std::string_view kMagic = "A351TRU2";
constexpr std::size_t kHeaderSize = 16;
constexpr std::size_t kRecordSize = 40;
constexpr std::size_t kReserved = 7;

template <class Integer>
void put(char*& at, Integer value) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
        *at++ = static_cast<char>((bits >> (8 * i)) & 0xFFU);
    }
}

template <class Integer>
Integer take(const char*& at) {
    std::make_unsigned_t<Integer> bits = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
        const auto byte = static_cast<unsigned char>(*at++);
        bits = static_cast<std::make_unsigned_t<Integer>>(
            bits | static_cast<std::make_unsigned_t<Integer>>(byte) << (8 * i));
    }
    return static_cast<Integer>(bits);
}

}  // namespace

void TruthWriter::require_own(const std::filesystem::path& file) {
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

TruthWriter::TruthWriter(std::filesystem::path file)
    : path_((require_own(file), std::move(file))), out_(path_, std::ios::binary | std::ios::trunc) {
    std::array<char, kHeaderSize> header{};
    std::memcpy(header.data(), kMagic.data(), kMagic.size());
    char* at = header.data() + kMagic.size();
    put(at, static_cast<std::uint32_t>(kRecordSize));
    out_.write(header.data(), header.size());
    require_good();
}

void TruthWriter::require_good() const {
    if (!out_) throw std::system_error(errno, std::generic_category(), path_.string());
}

void TruthWriter::append(const TruthRecord& record) {
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

void TruthWriter::close() {
    out_.close();
    require_good();
}

std::vector<TruthRecord> read_truth(const std::filesystem::path& file) {
    const std::string bytes = text::read_text_file(file);
    if (bytes.size() < kHeaderSize || !bytes.starts_with(kMagic) ||
        (bytes.size() - kHeaderSize) % kRecordSize != 0) {
        throw InputError(file.string() + ": no truth file; allowed: " + std::string(kMagic) +
                         ", then records of " + std::to_string(kRecordSize) + " bytes");
    }
    std::vector<TruthRecord> records;
    const char* at = bytes.data() + kHeaderSize;
    while (at != bytes.data() + bytes.size()) {
        TruthRecord record;
        record.utc = UtcTime(Nanoseconds(take<std::int64_t>(at)));
        for (std::int32_t& axis : record.values.axes) axis = take<std::int32_t>(at);
        record.values.temperature = take<std::int32_t>(at);
        record.values.count = take<std::uint16_t>(at);
        record.sampling_run = take<std::uint16_t>(at);
        record.grid_index = take<std::uint32_t>(at);
        const auto fate = take<std::uint8_t>(at);
        if (fate > static_cast<std::uint8_t>(Fate::misplaced)) {
            throw InputError(file.string() + ": record " + std::to_string(records.size()) +
                             ": fate = " + std::to_string(fate) + "; allowed: 0 to 4");
        }
        record.fate = static_cast<Fate>(fate);
        at += kReserved;
        records.push_back(record);
    }
    return records;
}

}  // namespace a351::sim
