#include "daemon/stream/own_positions.hpp"

#include <fmt/core.h>

#include <sstream>

#include "protocol/archive/archive_writer.hpp"

namespace a351::daemon::stream {

std::string to_text(const Positions& positions) {
    constexpr int kDecimals = 9;
    std::string text;
    for (const auto& [stream, position] : positions) {
        text += fmt::format("{} {} {} {} {}\n", stream, position.packet, position.mark.sequence,
                            to_rfc3339(position.mark.start, kDecimals),
                            to_rfc3339(position.mark.end, kDecimals));
    }
    return text;
}

std::optional<Positions> parse_positions(const std::string& text) {
    if (!text.empty() && !text.ends_with('\n')) return std::nullopt;
    Positions positions;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string stream, start, end, more;
        Position position;
        words >> stream >> position.packet >> position.mark.sequence >> start >> end;
        const auto first = parse_rfc3339(start), last = parse_rfc3339(end);
        if (!words || words >> more || !first || !last || position.mark.sequence < 1 ||
            position.mark.sequence > archive::kLargestSequence)
            return std::nullopt;
        position.mark.start = *first;
        position.mark.end = *last;
        positions[stream] = position;
    }
    return positions;
}

}  // namespace a351::daemon::stream
