#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector {
namespace {

constexpr std::size_t kArrays = 12;
// Elements that are read beyond the last knot: eight cubics are read at a time, from any knot.
constexpr std::size_t kReadBeyond = 8;

/// Returns the number of elements from one array to the next.  Two addresses with the same last
/// twelve bits (512 doubles) delay each other if one is written and the other is read.  Twelve
/// arrays with offsets of 40 elements never have the same.
constexpr std::size_t stride(std::size_t knots) {
    return (knots + kReadBeyond + 511) / 512 * 512 + 40;
}

}  // namespace

MeanEnvelope::MeanEnvelope(std::size_t most_knots)
    : storage_(kArrays * stride(most_knots)), arrays_{} {
    const auto array = [&](std::size_t i) { return storage_.data() + i * stride(most_knots); };
    arrays_.h = array(0);
    arrays_.inverse = array(1);
    arrays_.slope = array(2);
    arrays_.pivot = array(3);
    arrays_.link = array(4);
    arrays_.c = array(5);
    arrays_.b = array(6);
    arrays_.e = array(7);
    arrays_.mean_y = array(8);
    arrays_.mean_b = array(9);
    arrays_.mean_c = array(10);
    arrays_.mean_e = array(11);
}

}  // namespace a351::corrector
