#include "sim/device/flash_memory.hpp"

#include <fmt/core.h>

#include <charconv>
#include <span>
#include <string>

#include "protocol/files/file_layer.hpp"
#include "protocol/text/strict_toml.hpp"
#include "sim/device/register_file.hpp"

namespace a351::sim::device {
namespace {

constexpr std::int64_t kFormat = 1;
constexpr std::size_t kBytesPerLine = 32;

std::string to_toml(const FlashMemory& memory) {
    std::string text = fmt::format(
        "# Flash memory of the emulated sensor.\nformat = {}\n\n[registers]\n", kFormat);
    std::size_t i = 0;
    for (const wire::Register& reg : wire::kRegisters) {
        if (!reg.is_saved_in_flash) continue;
        text += fmt::format("{} = 0x{:04X}\n", reg.name, memory.settings[i++]);
    }
    text += "\n[user_filter]\nbytes = [";
    std::size_t count = memory.coefficients.size();
    while (count > 0 && memory.coefficients[count - 1] == FlashMemory::kErased) --count;
    for (std::size_t at = 0; at < count; ++at) {
        if (at % kBytesPerLine == 0) text += at == 0 ? "\n  \"" : "\",\n  \"";
        text += fmt::format("{:02X}", memory.coefficients[at]);
    }
    return text + (count == 0 ? "]\n" : "\"\n]\n");
}

void read_coefficients(text::TomlTable& table, FlashMemory& memory) {
    std::string digits;
    for (const std::string& line : table.strings("bytes")) digits += line;
    if (digits.size() % 2 != 0 || digits.size() / 2 > memory.coefficients.size()) {
        table.refuse("bytes", "wrong number of digits",
                     fmt::format("two per byte, at most {} bytes", memory.coefficients.size()));
    }
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        const char* end = digits.data() + i + 2;
        if (std::from_chars(digits.data() + i, end, memory.coefficients[i / 2], 16).ptr != end)
            table.refuse("bytes", "not hexadecimal: " + digits.substr(i, 2), "0 ... 9, A ... F");
    }
}

}  // namespace

FlashMemory read_flash_file(const std::filesystem::path& file, const wire::DeviceProfile& profile) {
    FlashMemory memory;
    if (!std::filesystem::exists(file)) return memory;
    text::TomlTable document = text::read_toml(file);
    static_cast<void>(document.integer_or("format", 0, kFormat, kFormat));
    if (!document.has("format")) document.refuse("format", "missing", fmt::format("{}", kFormat));
    text::TomlTable registers = document.table("registers");
    RegisterFile held;
    std::size_t i = 0;
    for (const wire::Register& reg : wire::kRegisters) {
        if (!reg.is_saved_in_flash) continue;
        if (!registers.has(reg.name)) registers.refuse(reg.name, "missing", "0 ... 0xFFFF");
        const auto value =
            static_cast<std::uint16_t>(registers.integer_or(reg.name, 0, 0, wire::kBothBytes));
        if ((value & ~reg.defined_bits) != 0 || !may_hold(profile, reg, value))
            registers.refuse(reg.name, "reserved", "a value that the device accepts");
        memory.settings[i++] = held.at(reg) = value;
    }
    if (!has_rate_for_long_filter(profile, held))
        registers.refuse(kLongFilter.name, "SMPL_CTRL is too fast for it", "up to 500 samples/s");
    registers.require_all_read();
    text::TomlTable user_filter = document.table("user_filter");
    read_coefficients(user_filter, memory);
    user_filter.require_all_read();
    document.require_all_read();
    return memory;
}

void write_flash_file(const std::filesystem::path& file, const FlashMemory& memory) {
    const std::string text = to_toml(memory);
    files::replace_file(files::posix_files(), file, std::as_bytes(std::span(text)));
}

}  // namespace a351::sim::device
