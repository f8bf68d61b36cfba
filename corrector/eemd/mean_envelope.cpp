#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector {
namespace {

constexpr std::size_t kArrays = 10;
// Four cubics are read at a time, beginning at any of them.
constexpr std::size_t kReadBeyond = 4;

}  // namespace

MeanEnvelope::MeanEnvelope(std::size_t most_knots)
    : storage_(kArrays * (most_knots + kReadBeyond)), arrays_{} {
    const auto array = [&](std::size_t i) {
        return storage_.data() + i * (most_knots + kReadBeyond);
    };
    arrays_.h = array(0);
    arrays_.inverse = array(1);
    arrays_.slope = array(2);
    arrays_.diagonal = array(3);
    arrays_.product = array(4);
    arrays_.right = array(5);
    arrays_.pivot = array(6);
    arrays_.former = array(7);
    arrays_.c = array(8);
    // From here on what is needed after the elimination, in place of what is not.
    arrays_.b = array(3);
    arrays_.e = array(4);
    arrays_.mean_y = array(5);
    arrays_.mean_b = array(6);
    arrays_.mean_c = array(7);
    arrays_.mean_e = array(9);
}

}  // namespace a351::corrector
