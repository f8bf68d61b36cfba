#include "protocol/text/text_file.hpp"

#include <vector>

#include "protocol/core/input_error.hpp"

namespace a351::text {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
    throw InputError(file.string() + ": cannot be read; allowed: a readable file");
}

}  // namespace

std::ifstream open_file(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
        throw InputError(file.string() + ": is not a regular file; allowed: a readable file");
    std::ifstream in(file, std::ios::binary);
    if (!in.is_open()) refuse(file);
    return in;
}

std::string read_text_file(const std::filesystem::path& file) {
    std::string content;
    read_file_in_blocks(file, [&content](std::string_view block) { content += block; });
    return content;
}

void read_file_in_blocks(const std::filesystem::path& file,
                         const std::function<void(std::string_view block)>& take) {
    constexpr std::size_t kBlock = 65536;
    std::ifstream in = open_file(file);
    std::vector<char> block(kBlock);
    while (in) {
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        take({block.data(), static_cast<std::size_t>(in.gcount())});
    }
    if (in.bad()) refuse(file);
}

}  // namespace a351::text
