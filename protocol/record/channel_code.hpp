#pragma once

#include <string>
#include <string_view>

namespace a351::record {

/// SEED channel code: band code of a broad-band sensor at this rate, then instrument and axis, as
/// in BNZ at 50 Hz and HNZ at 100 Hz.  SEED reference manual 2.4, appendix A.
[[nodiscard]] inline std::string channel_code(int rate_hz, std::string_view instrument_and_axis) {
    const char band = rate_hz >= 1000 ? 'F' : rate_hz >= 250 ? 'C' : rate_hz >= 80 ? 'H' : 'B';
    return band + std::string(instrument_and_axis);
}

}  // namespace a351::record
