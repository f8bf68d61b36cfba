#include "protocol/text/input_file.hpp"

#include <fmt/core.h>
#include <openssl/evp.h>

#include <array>
#include <boost/crc.hpp>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "protocol/text/text_file.hpp"

namespace a351::text {

void to_json(nlohmann::ordered_json& json, const InputFile& input) {
    json = {{"role", input.role},
            {"name", input.name},
            {"byte_count", input.byte_count},
            {"crc32", input.crc32}};
}

InputFile describe_input(std::string role, const std::filesystem::path& file) {
    boost::crc_32_type crc;
    std::uint64_t byte_count = 0;
    read_file_in_blocks(file, [&](std::string_view block) {
        crc.process_bytes(block.data(), block.size());
        byte_count += block.size();
    });
    return {std::move(role), file.filename().string(), byte_count, crc.checksum(), file};
}

std::string sha256_of_file(const std::filesystem::path& file) {
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                          &EVP_MD_CTX_free);
    // With a built-in digest these calls fail only if memory runs out.
    const auto require = [](int result) {
        if (result != 1) throw std::bad_alloc();
    };
    require(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr));
    read_file_in_blocks(file, [&](std::string_view block) {
        require(EVP_DigestUpdate(context.get(), block.data(), block.size()));
    });
    constexpr std::size_t kBytes = 32;
    std::array<unsigned char, kBytes> digest{};
    require(EVP_DigestFinal_ex(context.get(), digest.data(), nullptr));
    std::string digits;
    for (const unsigned char byte : digest) digits += fmt::format("{:02x}", byte);
    return digits;
}

}  // namespace a351::text
