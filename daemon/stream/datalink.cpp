#include "daemon/stream/datalink.hpp"

#include <fmt/core.h>

#include <pugixml.hpp>

#include "protocol/core/whole_number.hpp"

namespace a351::daemon::stream {
namespace {

constexpr std::size_t kMostData = std::size_t{16} * 1024 * 1024;
constexpr std::string_view kType = "/MSEED";

std::vector<std::string> words_of(std::string_view text, char separator) {
    std::vector<std::string> words;
    while (!text.empty()) {
        const auto end = std::min(text.find(separator), text.size());
        words.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

std::int64_t microseconds(UtcTime time) {
    return floor<std::chrono::microseconds>(time).time_since_epoch().count();
}

/// Returns NET_STA_LOC_CHAN for a stream of a ring: XX_A351_00_BNZ/MSEED, or as FDSN's identifier
/// FDSN:XX_A351_00_B_N_Z/MSEED.  Empty for another type.
std::string plain_name(std::string_view name) {
    constexpr std::string_view kFdsn = "FDSN:";
    if (!name.ends_with(kType)) return {};
    name.remove_suffix(kType.size());
    if (!name.starts_with(kFdsn)) return std::string(name);
    const auto parts = words_of(name.substr(kFdsn.size()), '_');
    if (parts.size() != 6) return {};
    return fmt::format("{}_{}_{}_{}{}{}", parts[0], parts[1], parts[2], parts[3], parts[4],
                       parts[5]);
}

}  // namespace

std::string make_packet(std::string_view header, std::string_view data) {
    std::string packet = "DL";
    packet += static_cast<char>(static_cast<unsigned char>(header.size()));
    packet += header;
    packet += data;
    return packet;
}

std::string make_write(const Record& record) {
    return make_packet(
        fmt::format("WRITE {}{} {} {} A {}", record.stream, kType, microseconds(record.mark.start),
                    microseconds(record.mark.end), record.bytes.size()),
        {reinterpret_cast<const char*>(record.bytes.data()), record.bytes.size()});
}

std::uint64_t AnswerHeader::value() const {
    const auto value = words.size() > 1 ? parse_whole<std::uint64_t>(words[1]) : std::nullopt;
    if (!value) throw RingError(fmt::format("it answers {} without a number", kind()));
    return *value;
}

std::size_t header_length(std::string_view preheader) {
    if (!preheader.starts_with("DL")) throw RingError("it does not speak DataLink");
    return static_cast<unsigned char>(preheader[2]);
}

AnswerHeader parse_header(std::string_view header) {
    AnswerHeader answer{words_of(header, ' ')};
    const auto is = [&](std::string_view kind) {
        return !answer.words.empty() && answer.kind() == kind;
    };
    if (is("ID")) return answer;
    const auto size =
        answer.words.size() > 1 ? parse_whole<std::uint64_t>(answer.words.back()) : std::nullopt;
    const bool is_known = is("OK") || is("ERROR") || is("INFO") || is("PACKET");
    if (!is_known || !size || *size > kMostData)
        throw RingError("it sends what is not an answer of DataLink");
    answer.data_size = *size;
    return answer;
}

std::map<std::string, std::uint64_t> parse_streams(std::string_view xml) {
    pugi::xml_document document;
    if (!document.load_buffer(xml.data(), xml.size()) || !document.child("DataLink"))
        throw RingError("its list of streams cannot be read");
    std::map<std::string, std::uint64_t> streams;
    for (const auto& stream : document.child("DataLink").child("StreamList").children("Stream")) {
        const std::string name = plain_name(stream.attribute("Name").value());
        const auto id = parse_whole<std::uint64_t>(stream.attribute("LatestPacketID").value());
        if (!id) throw RingError("its list of streams cannot be read");
        if (!name.empty()) streams[name] = *id;
    }
    return streams;
}

}  // namespace a351::daemon::stream
