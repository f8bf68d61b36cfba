#include "daemon/ctl/phone.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <qrencode.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <memory>
#include <system_error>

namespace a351::daemon::ctl {
namespace {

constexpr int kQuietModules = 4;  // Light border of a code, ISO/IEC 18004.

bool is_reachable(const ifaddrs& one) {
    return one.ifa_addr != nullptr && one.ifa_addr->sa_family == AF_INET &&
           (one.ifa_flags & IFF_UP) != 0 && (one.ifa_flags & IFF_LOOPBACK) == 0;
}

}  // namespace

std::vector<std::string> reachable_addresses(const std::string& listen) {
    if (listen.starts_with("127.") || listen == "[::1]") return {};
    if (listen != "0.0.0.0" && listen != "[::]") return {listen};
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0)
        throw std::system_error(errno, std::generic_category(), "addresses of this host");
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(first, freeifaddrs);
    std::vector<std::string> addresses;
    for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
        if (!is_reachable(*one)) continue;
        std::array<char, INET_ADDRSTRLEN> text{};
        const auto* const address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
        inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
        addresses.emplace_back(text.data());
    }
    return addresses;
}

std::string page_url(const std::string& authority, std::string_view token) {
    std::string url = "http://" + authority + "/#token=";
    for (const char c : token) {
        const auto byte = static_cast<unsigned char>(c);
        url += std::isalnum(byte) != 0 ? std::string(1, c) : fmt::format("%{:02X}", byte);
    }
    return url;
}

std::string qr_text(const std::string& text, bool has_colour) {
    const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
        QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_L, QR_MODE_8, 1), QRcode_free);
    if (!code) throw std::system_error(errno, std::generic_category(), "QR code");
    const auto is_light = [&](int row, int column) {
        if (row < 0 || row >= code->width || column < 0 || column >= code->width) return true;
        return (code->data[row * code->width + column] & 1) == 0;
    };
    // Upper and lower half of a letter: dark and dark, light and dark, dark and light, both light.
    constexpr std::array kLetters{" ", "\u2580", "\u2584", "\u2588"};
    std::string shown;
    for (int row = -kQuietModules; row < code->width + kQuietModules; row += 2) {
        if (has_colour) shown += "\x1b[97;40m";
        for (int column = -kQuietModules; column < code->width + kQuietModules; ++column)
            shown += kLetters.at((is_light(row, column) ? 1U : 0U) +
                                 (is_light(row + 1, column) ? 2U : 0U));
        shown += has_colour ? "\x1b[0m\n" : "\n";
    }
    return shown;
}

}  // namespace a351::daemon::ctl
