#include "sim/device/flash_file.hpp"

#include <charconv>
#include <span>
#include <string>

#include "protocol/files/file_layer.hpp"
#include "protocol/text/strict_toml.hpp"
#include "sim/device/register_file.hpp"

namespace a351::sim {
namespace {

constexpr std::int64_t kFormat = 1;
constexpr std::size_t kBytesPerLine = 32;
constexpr std::string_view kDigits = "0123456789ABCDEF";

void append_hex(std::string& text, unsigned value, int digits) {
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
        text += kDigits[(value >> shift) & 0xFU];
    }
}

std::size_t written_bytes(const FlashMemory& memory) {
    std::size_t count = memory.coefficients.size();
    while (count > 0 && memory.coefficients[count - 1] == FlashMemory::kErased) --count;
    return count;
}

std::string to_toml(const FlashMemory& memory) {
    std::string text =
        "# Flash memory of the emulated sensor.\nformat = " + std::to_string(kFormat) +
        "\n\n[registers]\n";
    std::size_t i = 0;
    for (const wire::Register& reg : wire::kRegisters) {
        if (!reg.is_saved_in_flash) continue;
        text += std::string(reg.name) + " = 0x";
        append_hex(text, memory.settings[i++], 4);
        text += '\n';
    }
    text += "\n[user_filter]\nbytes = [";
    const std::size_t count = written_bytes(memory);
    for (std::size_t at = 0; at < count; ++at) {
        if (at % kBytesPerLine == 0) text += at == 0 ? "\n  \"" : "\",\n  \"";
        append_hex(text, memory.coefficients[at], 2);
    }
    return text + (count == 0 ? "]\n" : "\"\n]\n");
}

void read_coefficients(text::TomlTable& table, FlashMemory& memory) {
    std::string digits;
    for (const std::string& line : table.strings("bytes")) digits += line;
    if (digits.size() % 2 != 0 || digits.size() / 2 > memory.coefficients.size()) {
        table.refuse(
            "bytes", "wrong number of digits",
            "two per byte, at most " + std::to_string(memory.coefficients.size()) + " bytes");
    }
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        const char* end = digits.data() + i + 2;
        if (std::from_chars(digits.data() + i, end, memory.coefficients[i / 2], 16).ptr != end) {
            table.refuse("bytes", "not hexadecimal: " + digits.substr(i, 2), "0 ... 9, A ... F");
        }
    }
}

}  // namespace

FlashMemory read_flash_file(const std::filesystem::path& file, const wire::DeviceProfile& profile) {
    FlashMemory memory;
    if (!std::filesystem::exists(file)) return memory;
    text::TomlTable document = text::read_toml(file);
    static_cast<void>(document.integer_or("format", 0, kFormat, kFormat));
    if (!document.has("format")) document.refuse("format", "missing", std::to_string(kFormat));
    text::TomlTable registers = document.table("registers");
    RegisterFile held;
    std::size_t i = 0;
    for (const wire::Register& reg : wire::kRegisters) {
        if (!reg.is_saved_in_flash) continue;
        if (!registers.has(reg.name)) registers.refuse(reg.name, "missing", "0 ... 0xFFFF");
        const auto value =
            static_cast<std::uint16_t>(registers.integer_or(reg.name, 0, 0, wire::kBothBytes));
        if ((value & ~reg.defined_bits) != 0 || !may_hold(profile, reg, value)) {
            registers.refuse(reg.name, "reserved", "a value that the device accepts");
        }
        memory.settings[i++] = held.at(reg) = value;
    }
    if (!has_rate_for_long_filter(profile, held)) {
        registers.refuse(kLongFilter.name, "SMPL_CTRL is too fast for it", "up to 500 samples/s");
    }
    registers.require_all_read();
    text::TomlTable user_filter = document.table("user_filter");
    read_coefficients(user_filter, memory);
    user_filter.require_all_read();
    document.require_all_read();
    return memory;
}

void write_flash_file(const std::filesystem::path& file, const FlashMemory& memory) {
    const std::string text = to_toml(memory);
    record::replace_file(record::posix_files(), file, std::as_bytes(std::span(text)));
}

}  // namespace a351::sim
