#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector::eemd {
namespace {

constexpr std::size_t kArrays = 8;
// Elements that are read beyond the last knot: eight cubics are read at a time, from any knot.
constexpr std::size_t kReadBeyond = 8;

/// Returns the number of elements from one array to the next.  Two addresses with the same last
/// twelve bits (512 doubles) delay each other if one is written and the other is read.  Eight
/// arrays with offsets of 40 elements never have the same.
constexpr std::size_t stride(std::size_t knots) {
    return (knots + kReadBeyond + 511) / 512 * 512 + 40;
}

}  // namespace

MeanEnvelope::MeanEnvelope(std::size_t most_knots)
    : storage_(kArrays * stride(most_knots)), arrays_{} {
    const auto array = [&](std::size_t i) { return storage_.data() + i * stride(most_knots); };
    arrays_ = {array(0), array(1), array(2), array(3), array(4), array(5), array(6), array(7)};
}

}  // namespace a351::corrector::eemd
