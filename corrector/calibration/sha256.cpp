#include "corrector/calibration/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <memory>
#include <new>
#include <string_view>

#include "protocol/text/text_file.hpp"

namespace a351::corrector {

std::string sha256_of_file(const std::filesystem::path& file) {
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                          &EVP_MD_CTX_free);
    // None of these calls fails for a digest that is built in, but for want of memory.
    const auto require = [](int result) {
        if (result != 1) throw std::bad_alloc();
    };
    require(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr));
    text::read_file_in_blocks(file, [&](std::string_view block) {
        require(EVP_DigestUpdate(context.get(), block.data(), block.size()));
    });
    constexpr std::size_t kBytes = 32;
    std::array<unsigned char, kBytes> digest{};
    require(EVP_DigestFinal_ex(context.get(), digest.data(), nullptr));
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += kDigits[byte / 16U];
        text += kDigits[byte % 16U];
    }
    return text;
}

}  // namespace a351::corrector
