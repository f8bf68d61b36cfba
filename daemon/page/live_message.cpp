#include "daemon/page/live_message.hpp"

#include <bit>
#include <cassert>
#include <chrono>
#include <cstring>

namespace a351::daemon::page {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kSamples = 1;

static_assert(std::endian::native == std::endian::little);

template <class Value>
void append(std::string& bytes, Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

}  // namespace

std::string encoded(const live::Block& block) {
    const std::size_t count = block.counts.front().size();
    std::string bytes;
    bytes.reserve(kLiveHeaderSize + block.counts.size() * count * sizeof(std::int32_t));
    append(bytes, kVersion);
    append(bytes, kSamples);
    append(bytes, static_cast<std::uint16_t>((1U << block.counts.size()) - 1U));
    append(bytes, static_cast<std::uint32_t>(count));
    append(bytes, block.first_index);
    append(bytes,
           std::chrono::duration<double, std::milli>(block.first_time.time_since_epoch()).count());
    append(bytes, 1e3 * block.interval_s);
    assert(bytes.size() == kLiveHeaderSize);
    for (const auto& channel : block.counts) {
        assert(channel.size() == count);
        for (const std::int32_t value : channel) append(bytes, value);
    }
    return bytes;
}

void LiveMessages::push(LiveMessage message) {
    byte_count_ += message.bytes.size();
    messages_.push_back(std::make_shared<const LiveMessage>(std::move(message)));
    ++end_;
    while (messages_.size() > 1 &&
           (messages_.size() > kMostMessagesKept || byte_count_ > kMostBytesKept)) {
        byte_count_ -= messages_.front()->bytes.size();
        messages_.pop_front();
    }
}

std::shared_ptr<const LiveMessage> LiveMessages::next(std::uint64_t& position,
                                                      std::uint64_t& missed) const {
    const std::uint64_t oldest = end_ - messages_.size();
    if (position < oldest) {
        missed += oldest - position;
        position = oldest;
    }
    if (position == end_) return nullptr;
    return messages_[static_cast<std::size_t>(position++ - oldest)];
}

}  // namespace a351::daemon::page
