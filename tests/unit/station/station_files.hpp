#pragma once
/// @file
/// A station as the daemon describes it, and its metadata as a file.

#include <filesystem>
#include <optional>
#include <string>

#include "protocol/station/station_xml.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"

namespace a351::station {

inline Description description() {
    Description station;
    station.latitude = Degrees(36.106);
    station.longitude = Degrees(140.087);
    station.elevation = Metres(25.5);
    station.start = *parse_rfc3339("2026-03-01T12:00:00Z");
    station.profile = "A351";
    station.product_id = "A352AD10";
    station.serial_number = "X0000001";
    station.firmware = 258;
    station.output_rate_hz = 50;
    station.filter = "k512_fc9";
    station.group_delay = Nanoseconds(63'875'000);
    return station;
}

class File {
public:
    explicit File(const std::string& text) { test::write_bytes(path(), test::bytes_of(text)); }
    [[nodiscard]] std::filesystem::path path() const { return directory_.path() / "station.xml"; }
    [[nodiscard]] Metadata read(std::optional<UtcTime> at = std::nullopt) const {
        return read_station_xml(path(), at);
    }

private:
    test::TemporaryDirectory directory_;
};

}  // namespace a351::station
