#pragma once
/// @file
/// The page on a telephone in the same network: its address, with the token, as a QR code.

#include <string>
#include <string_view>
#include <vector>

namespace a351::daemon::ctl {

/// Returns the IPv4 addresses by which other devices reach a program on this host.
/// @param listen  the numeric address on which it listens; 0.0.0.0 means all of this host.
[[nodiscard]] std::vector<std::string> reachable_addresses(const std::string& listen);

/// Returns the address of the page with the token in the fragment, which browsers neither
/// send nor log.
/// @param authority  address and port.
[[nodiscard]] std::string page_url(const std::string& authority, std::string_view token);

/// Returns a text as a QR code (ISO/IEC 18004, correction level L) of half blocks, two modules
/// above each other in one letter.  Light modules are filled, so that the code is right on a dark
/// terminal.
/// @param has_colour  sets black on white, so that it is right on any terminal.
[[nodiscard]] std::string qr_text(const std::string& text, bool has_colour);

}  // namespace a351::daemon::ctl
