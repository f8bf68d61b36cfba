#pragma once
/// @file
/// Packets of the DataLink protocol 1.0 as bytes, without a connection.
///
/// A packet is "DL", the length of its header in one byte, the header in ASCII, and data whose size
/// is the last word of the header.  Source: EarthScope, libdali, "DataLink protocol 1.0".

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/stream/archive_streams.hpp"

namespace a351::daemon::stream {

/// Bytes before the header of each packet.
inline constexpr std::size_t kPreheader = 3;

/// Thrown if the ring does not answer, refuses, or answers against the protocol.
class RingError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns a packet.
/// @param header  at most 255 characters.
[[nodiscard]] std::string make_packet(std::string_view header, std::string_view data = {});

/// Returns the packet that writes a record to the ring and asks for an acknowledgement.
///
/// The stream is named NET_STA_LOC_CHAN/MSEED.  ringserver 4 changes this into FDSN's identifier.
[[nodiscard]] std::string make_write(const Record& record);

/// Header of an answer.
struct AnswerHeader {
    std::vector<std::string> words;  ///< At least one; the first is the kind of answer.
    std::size_t data_size = 0;       ///< Bytes that follow.

    [[nodiscard]] const std::string& kind() const { return words.front(); }
    /// Returns the number in OK or ERROR.
    /// @throws RingError  there is none.
    [[nodiscard]] std::uint64_t value() const;
};

/// Returns the length of the header that follows the first bytes of a packet.
/// @param preheader  kPreheader bytes.
/// @throws RingError  the bytes are not the begin of a packet.
[[nodiscard]] std::size_t header_length(std::string_view preheader);

/// Reads the header of an answer: ID, OK, ERROR, INFO or PACKET.
/// @throws RingError  it is another header, or its data are larger than 16 MiB: the list of 30 000
///                    streams has about 10 MiB.
[[nodiscard]] AnswerHeader parse_header(std::string_view header);

/// Reads the answer to INFO STREAMS.
/// @return the packet that the ring received last, by stream, named NET_STA_LOC_CHAN.  Other
///         streams are left out.
/// @throws RingError  it is no such document.
[[nodiscard]] std::map<std::string, std::uint64_t> parse_streams(std::string_view xml);

}  // namespace a351::daemon::stream
