#include "daemon/source/serial_ports.hpp"

#include <libserialport.h>

#include <algorithm>
#include <memory>

namespace a351::daemon {
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
    throw PortError(kind, device.string() + ": " + step + " failed");
}

}  // namespace

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
    std::sort(entries.begin(), entries.end(),
              [](const auto& a, const auto& b) { return a.path < b.path; });
    return entries;
}

std::optional<std::filesystem::path> find_usb_port(const UsbAddress& address) {
    for (const SerialPortEntry& entry : list_serial_ports()) {
        if (entry.usb == address) return entry.path;
    }
    return std::nullopt;
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
        throw PortError(PortError::Kind::settings, device.string() + ": the port runs at " +
                                                       std::to_string(kept_baud) +
                                                       " baud instead of " + std::to_string(baud));
    }
}

}  // namespace a351::daemon
