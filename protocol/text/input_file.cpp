#include "protocol/text/input_file.hpp"

#include <zlib.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "protocol/text/sha256.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {

void to_json(nlohmann::ordered_json& json, const InputFile& input) {
    json = {{"role", input.role},
            {"name", input.name},
            {"byte_count", input.byte_count},
            {"crc32", input.crc32}};
}

InputFile describe_input(std::string role, const std::filesystem::path& file) {
    uLong crc = crc32_z(0, nullptr, 0);
    std::uint64_t byte_count = 0;
    read_file_in_blocks(file, [&](std::string_view block) {
        crc = crc32_z(crc, reinterpret_cast<const Bytef*>(block.data()), block.size());
        byte_count += block.size();
    });
    return {std::move(role), file.filename().string(), byte_count,
            static_cast<std::uint32_t>(crc), file};
}

std::string sha256_of_file(const std::filesystem::path& file) {
    Sha256 digest;
    read_file_in_blocks(file, [&](std::string_view block) { digest.update(block); });
    return digest.hex();
}

}  // namespace a351::text
