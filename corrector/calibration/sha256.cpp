#include "corrector/calibration/sha256.hpp"

#include <openssl/sha.h>

#include <array>
#include <string_view>

#include "protocol/text/text_file.hpp"

namespace a351::corrector {

std::string sha256_of_file(const std::filesystem::path& file) {
    const std::string content = text::read_text_file(file);
    std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
    SHA256(reinterpret_cast<const unsigned char*>(content.data()), content.size(), digest.data());
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += kDigits[byte / 16U];
        text += kDigits[byte % 16U];
    }
    return text;
}

}  // namespace a351::corrector
