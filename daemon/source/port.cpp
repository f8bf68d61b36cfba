#include "daemon/source/port.hpp"

#include <fmt/core.h>
#include <libserialport.h>

#include <algorithm>

#include "daemon/source/tty_port.hpp"

namespace a351::daemon::source {
namespace {

struct FreePort {
    void operator()(sp_port* port) const noexcept {
        sp_close(port);
        sp_free_port(port);
    }
};
struct FreeConfig {
    void operator()(sp_port_config* config) const noexcept { sp_free_config(config); }
};

std::filesystem::path by_id_name(const std::filesystem::path& device) {
    std::error_code error;
    for (std::filesystem::directory_iterator links("/dev/serial/by-id", error), end;
         !error && links != end; links.increment(error)) {
        std::error_code unresolved;
        if (std::filesystem::canonical(links->path(), unresolved) == device) return links->path();
    }
    return {};
}

void require(sp_return result, const std::filesystem::path& device, const char* step) {
    if (result >= SP_OK) return;
    const auto kind = result == SP_ERR_FAIL ? PortError::Kind::absent : PortError::Kind::settings;
    throw PortError(kind, device, std::string(step) + " failed");
}

}  // namespace

std::string UsbAddress::to_text() const {
    return fmt::format("{:04x}:{:04x}:{}", vendor, product, serial);
}

std::string PortAddress::to_text() const { return usb ? "USB " + usb->to_text() : path.string(); }

std::unique_ptr<Port> open_port(const PortAddress& address, int baud) {
    std::filesystem::path device = address.path;
    if (address.usb) {
        const auto entries = list_serial_ports();
        const auto found = std::ranges::find(entries, address.usb, &SerialPortEntry::usb);
        if (found == entries.end())
            throw PortError(PortError::Kind::absent, address.to_text(), "not plugged in");
        device = found->path;
    }
    std::error_code error;
    device = std::filesystem::canonical(device, error);
    if (error == std::errc::no_such_file_or_directory)
        throw PortError(PortError::Kind::absent, address.to_text(),
                        "there is no such port; check the cable, and a351d --list-ports");
    if (error) throw PortError(PortError::Kind::absent, address.to_text(), error.message());
    return std::make_unique<TtyPort>(device, baud);
}

std::string port_table(const std::vector<SerialPortEntry>& ports) {
    constexpr int kFtdi = 0x0403;
    std::string table = "PORT\tBY-ID\tUSB VID:PID:SERIAL\tREMARK\n";
    for (const SerialPortEntry& port : ports)
        table += fmt::format(
            "{}\t{}\t{}\t{}\n", port.path.string(), port.by_id.empty() ? "-" : port.by_id.string(),
            port.usb ? port.usb->to_text() : "-",
            port.usb && port.usb->vendor == kFtdi ? "FTDI: could be the sensor" : "-");
    return table;
}

std::vector<SerialPortEntry> list_serial_ports() {
    std::vector<SerialPortEntry> entries;
    sp_port** ports = nullptr;
    if (sp_list_ports(&ports) != SP_OK) return entries;
    for (sp_port** port = ports; *port != nullptr; ++port) {
        SerialPortEntry entry;
        entry.path = sp_get_port_name(*port);
        entry.by_id = by_id_name(entry.path);
        UsbAddress usb;
        if (sp_get_port_usb_vid_pid(*port, &usb.vendor, &usb.product) == SP_OK) {
            const char* const serial = sp_get_port_usb_serial(*port);
            usb.serial = serial == nullptr ? "" : serial;
            entry.usb = usb;
        }
        entries.push_back(std::move(entry));
    }
    sp_free_port_list(ports);
    std::ranges::sort(entries, {}, &SerialPortEntry::path);
    return entries;
}

void configure_serial_port(const std::filesystem::path& device, int baud) {
    sp_port* found = nullptr;
    require(sp_get_port_by_name(device.c_str(), &found), device, "look-up");
    const std::unique_ptr<sp_port, FreePort> port(found);
    require(sp_open(port.get(), SP_MODE_READ_WRITE), device, "open");

    sp_port_config* made = nullptr;
    require(sp_new_config(&made), device, "configuration");
    const std::unique_ptr<sp_port_config, FreeConfig> config(made);
    sp_set_config_baudrate(config.get(), baud);
    sp_set_config_bits(config.get(), 8);
    sp_set_config_parity(config.get(), SP_PARITY_NONE);
    sp_set_config_stopbits(config.get(), 1);
    sp_set_config_flowcontrol(config.get(), SP_FLOWCONTROL_NONE);
    require(sp_set_config(port.get(), config.get()), device, "setting 8N1 without flow control");

    int kept_baud = 0;
    require(sp_get_config(port.get(), config.get()), device, "reading the settings back");
    sp_get_config_baudrate(config.get(), &kept_baud);
    if (kept_baud != baud) {
        throw PortError(PortError::Kind::settings, device,
                        fmt::format("the port runs at {} baud instead of {}", kept_baud, baud));
    }
}

}  // namespace a351::daemon::source
