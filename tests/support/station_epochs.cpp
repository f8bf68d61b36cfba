// Writes station metadata with a growing number of epochs to OUT: one.xml, two.xml (then another
// sensor with a declared rate) and oven.xml (then the same sensor with an oven).
//   station-epochs OUT

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "protocol/station/station_xml.hpp"

using namespace a351;

int main(int argc, char** argv) {
    using namespace a351;
    if (argc != 2) {
        std::cerr << "usage: station-epochs OUT\n";
        return 2;
    }
    const std::filesystem::path out = argv[1];
    const auto write = [&](const char* name, const std::string& text) {
        std::ofstream(out / name, std::ios::binary) << text;
    };
    station::Description station;
    station.latitude = Degrees(36.106);
    station.longitude = Degrees(140.087);
    station.elevation = Metres(25.5);
    station.start = *parse_rfc3339("2026-03-01T12:00:00Z");
    station.profile = "A351";
    station.product_id = "A351AU10";
    station.serial_number = "00000042";
    station.output_rate_hz = 50;
    station.filter = "k512_fc9";
    write("one.xml", station::to_station_xml(station));
    station.start += std::chrono::hours(24);
    station.serial_number = "00000043";
    station.declared_rate_hz = 50.0006;
    write("two.xml", station::extend_station_xml(out / "one.xml", station).value());
    station.has_oven = true;
    station.start += std::chrono::hours(24);
    write("oven.xml", station::extend_station_xml(out / "two.xml", station).value());
}
