#include "corrector/archive_series/tilt.hpp"

#include <fmt/core.h>

#include <numbers>

#include "protocol/core/input_error.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::archive_series {

void require_horizontal(std::vector<double> tilts_urad, std::size_t axis, std::string_view option) {
    constexpr double kDegPerUrad = 180.0 / std::numbers::pi * 1e-6, kMost_deg = 45.0;
    if (tilts_urad.empty()) return;
    const double usual_deg = kDegPerUrad * signal::median(std::move(tilts_urad));
    if (std::abs(usual_deg) > kMost_deg)
        throw InputError(fmt::format(
            "{} = tilt-{}: this axis is {} deg from the horizontal; "
            "allowed: a horizontal axis, within {} deg",
            option, axis == 0 ? 'x' : 'y', text::fixed(usual_deg, 1), text::fixed(kMost_deg, 0)));
}

}  // namespace a351::corrector::archive_series
