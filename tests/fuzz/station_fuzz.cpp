/// @file
/// StationXML.  A file must be read, or refused by an InputError of one line.  One that is read must
/// also be read after a session has been added to it, and adding the session again changes nothing.

#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/station/station_xml.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using namespace a351::station;
using fuzz::require;

Description session() {
    Description session;
    session.start = *parse_rfc3339("2026-03-01T12:00:00Z");
    session.profile = "A351";
    session.serial_number = "00000001";
    session.output_rate_hz = 50;
    session.filter = "k512_fc9";
    return session;
}

void check(const Metadata& metadata) {
    for (const ChannelScale& channel : metadata.channels)
        require(std::isfinite(channel.gain) && std::isfinite(channel.offset) &&
                !channel.unit.empty() && channel.rate_hz.value_or(1.0) > 0.0);
}

void read_and_extend(const std::filesystem::path& file) {
    check(read_station_xml(file));
    for (const auto& [start, metadata] : read_station_epochs(file)) check(metadata);
    const auto extended = extend_station_xml(file, session());
    if (!extended) return;
    const auto longer = fuzz::file_of(*extended, "extended.xml");
    require(!extend_station_xml(longer, session()));
    check(read_station_xml(longer, session().start));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        read_and_extend(fuzz::file_of(fuzz::text_of(data, size), "station.xml"));
    } catch (const InputError& error) {
        require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
