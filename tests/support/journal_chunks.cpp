// Prints how each segment of a journal is read by itself: a line with its counter, a line
// `chunk TYPE SEQUENCE CRC` for each good chunk, with the checksum of its contents encoded again or
// 0 for a header, and a line `damage OFFSET BYTES` for each damage.
//   journal-chunks JOURNAL

#include <cstdio>

#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_reader.hpp"

int main(int argc, char** argv) {
    using namespace a351::journal;
    if (argc != 2) {
        std::fputs("usage: journal-chunks JOURNAL\n", stderr);
        return 2;
    }
    for (const auto& segment : segment_files(argv[1])) {
        std::printf("segment %d\n", static_cast<int>(segment_number(segment).value_or(0)));
        Reader reader(segment);
        while (const auto chunk = reader.next()) {
            const auto bytes = encode_chunk(*chunk, reader.sequence());
            const bool is_head = std::holds_alternative<Header>(*chunk);
            const ChunkHeader head = decode_chunk_header(bytes);
            std::printf("chunk %d %u %u\n", static_cast<int>(head.type), reader.sequence(),
                        is_head ? 0 : head.crc);
        }
        for (const Damage& damage : reader.damage())
            std::printf("damage %llu %llu\n", static_cast<unsigned long long>(damage.offset),
                        static_cast<unsigned long long>(damage.byte_count));
    }
}
