#include "daemon/identify/identify_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <vector>

#include "protocol/text/write_together.hpp"

namespace a351::daemon::identify {

std::string file_stem(const Observation& seen) {
    std::string serial_number = seen.device.serial_number;
    std::ranges::replace_if(
        serial_number, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return fmt::format("identify-{}-{}", serial_number.empty() ? "unknown" : serial_number,
                       to_compact(seen.time));
}

std::string file_text(const Observation& seen, const Report& report) {
    std::string text = fmt::format("a351d {} --identify, {}\n{}\n[registers]\n", A351_VERSION,
                                   to_rfc3339(seen.time), to_text(report));
    for (const auto& [reg, value] : seen.registers) {
        text += fmt::format("W{}:{:02X} {} {}\n", static_cast<int>(reg->window), reg->address,
                            reg->name, value ? fmt::format("0x{:04X}", *value) : "no answer");
    }
    text += "\n[bytes]\n";
    std::size_t begin = 0;
    for (const journal::ReadStamp& read : seen.reads) {
        const double after_s =
            std::chrono::duration<double>(read.time - seen.reads.front().time).count();
        text += fmt::format("{:.6f} ", after_s);
        for (; begin < read.end; ++begin)
            text += fmt::format("{:02x}", std::to_integer<unsigned>(seen.bytes[begin]));
        text += '\n';
    }
    return text;
}

std::string write_files(const std::filesystem::path& folder, const Observation& seen,
                        const Report& report) {
    const std::string stem = file_stem(seen);
    std::vector<text::NamedText> files{{stem + ".txt", file_text(seen, report)}};
    if (report.toml) files.emplace_back(stem + ".toml", *report.toml);
    text::write_together(folder, files);
    return stem;
}

}  // namespace a351::daemon::identify
