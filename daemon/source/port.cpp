#include "daemon/source/port.hpp"

#include <array>
#include <cstdio>

#include "daemon/source/serial_ports.hpp"
#include "daemon/source/tty_port.hpp"

namespace a351::daemon {

std::string UsbAddress::to_text() const {
    std::array<char, 16> numbers{};
    std::snprintf(numbers.data(), numbers.size(), "%04x:%04x:", static_cast<unsigned>(vendor),
                  static_cast<unsigned>(product));
    return numbers.data() + serial;
}

std::string PortAddress::to_text() const { return usb ? "USB " + usb->to_text() : path.string(); }

std::unique_ptr<Port> open_port(const PortAddress& address, int baud) {
    std::filesystem::path device = address.path;
    if (address.usb) {
        const auto found = find_usb_port(*address.usb);
        if (!found) {
            throw PortError(PortError::Kind::absent, address.to_text() + ": not plugged in");
        }
        device = *found;
    }
    std::error_code error;
    device = std::filesystem::canonical(device, error);
    if (error) {
        throw PortError(PortError::Kind::absent, address.to_text() + ": " + error.message());
    }
    return std::make_unique<TtyPort>(device, baud);
}

}  // namespace a351::daemon
