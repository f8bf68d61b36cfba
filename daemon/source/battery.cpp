#include "daemon/source/battery.hpp"

#include <fstream>
#include <string>
#include <system_error>

namespace a351::daemon::source {
namespace {

/// Returns the line of a file; empty if there is none.
std::string line_of(const std::filesystem::path& file) {
    std::string line;
    std::ifstream in(file);
    std::getline(in, line);
    return line;
}

}  // namespace

std::optional<Battery> read_battery(const std::filesystem::path& supplies) {
    int batteries = 0;
    Battery whole;
    std::error_code none;
    for (std::filesystem::directory_iterator supply(supplies, none), end; supply != end;
         supply.increment(none)) {
        const std::filesystem::path& folder = supply->path();
        if (line_of(folder / "type") != "Battery" || line_of(folder / "scope") == "Device")
            continue;
        double percent = 0.0;
        if (!(std::ifstream(folder / "capacity") >> percent)) continue;
        ++batteries;
        whole.percent += percent;
        whole.is_discharging |= line_of(folder / "status") == "Discharging";
    }
    if (batteries == 0) return std::nullopt;
    whole.percent /= batteries;
    return whole;
}

}  // namespace a351::daemon::source
