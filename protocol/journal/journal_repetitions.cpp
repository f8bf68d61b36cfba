#include "protocol/journal/journal_repetitions.hpp"

#include <algorithm>

namespace a351::record {

bool Repetitions::is_repeated(std::uint64_t segment, std::uint32_t sequence,
                              const JournalChunk& chunk) {
    if (const auto* header = std::get_if<JournalHeader>(&chunk)) {
        if (header->repeats && header->repeats != from_) {
            const bool was_read = last_segment_ == header->repeats->segment &&
                                  last_sequence_ >= header->repeats->sequence;
            chunks_read_ = was_read ? last_sequence_ - header->repeats->sequence + 1 : 0;
        }
        from_ = header->repeats;
        to_skip_ = from_ ? chunks_read_ : 0;
    } else if (sequence <= to_skip_) {
        return true;
    } else if (from_) {
        chunks_read_ = sequence;
    }
    last_segment_ = segment;
    last_sequence_ = sequence;
    return false;
}

}  // namespace a351::record
