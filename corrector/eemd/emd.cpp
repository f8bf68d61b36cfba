#include "corrector/eemd/emd.hpp"

namespace a351::corrector::eemd {
namespace {

/// Counts the consecutive sifts in which the number of extrema changed by at most one.
struct Stability {
    std::size_t maxima = 0, minima = 0;
    int repeats = -1;  ///< -1 before the first curve.

    void observe(std::size_t extrema, bool first_is_maximum) noexcept {
        const std::size_t maxima_now = (extrema + (first_is_maximum ? 1 : 0)) / 2;
        const std::size_t minima_now = extrema - maxima_now;
        const auto distance = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
        const std::size_t change = distance(maxima_now, maxima) + distance(minima_now, minima);
        repeats = repeats >= 0 && change <= 1 ? repeats + 1 : 0;
        maxima = maxima_now;
        minima = minima_now;
    }
};

}  // namespace

// The kernels work on whole groups of eight samples, hence seven more.
EmdWorkspace::EmdWorkspace(std::size_t sample_count, const SiftKernels& kernels)
    : kernels_(kernels),
      sample_count_(sample_count),
      residue_(sample_count + 7),
      mode_(sample_count + 7),
      knots_(sample_count),
      envelope_(sample_count + 2 * AlternatingKnots::kMostAdded) {}

std::span<const double> EmdWorkspace::next_mode(const SiftOptions& options) noexcept {
    if (sample_count_ < 2) return {};
    find_extrema(residue_.data());
    if (options.finish == FinishRule::at_most_two_extrema && knots_.extrema_count() <= 2) return {};
    const auto* fixed = std::get_if<FixedSifts>(&options.stopping);
    const auto* s_number = std::get_if<SNumber>(&options.stopping);
    const int limit = fixed != nullptr ? fixed->count : kMostSNumberSifts;
    Stability stability;
    const double* curve = residue_.data();
    for (int sifts = 0; sifts < limit; ++sifts) {
        if (sifts > 0) find_extrema(curve);
        if (s_number != nullptr) {
            stability.observe(knots_.extrema_count(), knots_.first_is_maximum());
            if (stability.repeats >= s_number->repeats && has_extrema_of_correct_sign()) break;
        }
        sift(curve, options.ends);
        curve = mode_.data();
    }
    kernels_.subtract(residue_.data(), mode_.data(), sample_count_);
    return {mode_.data(), sample_count_};
}

void EmdWorkspace::find_extrema(const double* curve) noexcept {
    const auto [positions, values, starts] = knots_.buffers();
    const std::size_t count =
        kernels_.find_extrema(curve, sample_count_, positions, values, starts);
    knots_.take(count, count > 0 && values[0] > curve[0]);
}

void EmdWorkspace::sift(const double* curve, EndRule ends) noexcept {
    knots_.add_ends({curve, sample_count_}, ends);
    const std::span<const double> x = knots_.positions();
    const std::span<const double> y = knots_.values();
    const double last_sample = curve[sample_count_ - 1];
    kernels_.fit_mean_envelope(x.data(), y.data(), x.size(), envelope_.arrays());
    kernels_.subtract_mean_envelope(curve, mode_.data(), sample_count_, knots_.segment_starts(),
                                    x.data(), knots_.first_segment(), envelope_.arrays());
    if (knots_.ends_at_last_sample()) {
        // The cubics are evaluated only before the last knots.  At the last sample the envelopes
        // have the values of the last two knots.
        mode_.data()[sample_count_ - 1] = last_sample - 0.5 * (y[y.size() - 2] + y.back());
    }
}

bool EmdWorkspace::has_extrema_of_correct_sign() const noexcept {
    bool maximum = knots_.first_is_maximum();
    for (const double value : knots_.extrema_values()) {
        if (maximum ? value <= 0.0 : value >= 0.0) return false;
        maximum = !maximum;
    }
    return true;
}

}  // namespace a351::corrector::eemd
