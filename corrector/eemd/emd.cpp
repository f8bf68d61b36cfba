#include "corrector/eemd/emd.hpp"

#include <algorithm>
#include <cassert>

namespace a351::corrector {
namespace {

/// Counts how often in a row the number of extrema stayed the same, within one.
class Stability {
public:
    void observe(std::size_t maxima, std::size_t minima) noexcept {
        const std::size_t change = distance(maxima, maxima_) + distance(minima, minima_);
        repeats_ = !first_ && change <= 1 ? repeats_ + 1 : 0;
        first_ = false;
        maxima_ = maxima;
        minima_ = minima;
    }
    [[nodiscard]] int repeats() const noexcept { return repeats_; }

private:
    static std::size_t distance(std::size_t a, std::size_t b) noexcept {
        return a > b ? a - b : b - a;
    }

    bool first_ = true;
    std::size_t maxima_ = 0;
    std::size_t minima_ = 0;
    int repeats_ = 0;
};

int sift_limit(const StoppingRule& stopping) noexcept {
    if (const auto* fixed = std::get_if<FixedSifts>(&stopping)) return fixed->count;
    if (const auto* s_number = std::get_if<SNumber>(&stopping)) return s_number->max_sifts;
    return 0;
}

}  // namespace

EmdWorkspace::EmdWorkspace(std::size_t sample_count)
    : maxima_(sample_count),
      minima_(sample_count),
      spline_(sample_count / 2 + 4),
      envelope_(sample_count) {}

void EmdWorkspace::decompose(std::span<const double> signal, const StoppingRule& stopping,
                             FinishRule finish, std::span<double> components) noexcept {
    const std::size_t n = signal.size();
    assert(n == envelope_.size() && (n == 0 || components.size() % n == 0));
    if (n == 0) return;
    const std::span<double> residue = components.last(n);
    std::copy(signal.begin(), signal.end(), residue.begin());
    bool finished = n < 2;
    for (std::size_t begin = 0; begin + n < components.size(); begin += n) {
        const std::span<double> mode = components.subspan(begin, n);
        std::copy(residue.begin(), residue.end(), mode.begin());
        finished = finished || !sift_out_mode(stopping, finish, mode);
        if (finished) std::fill(mode.begin(), mode.end(), 0.0);
        for (std::size_t i = 0; i < n; ++i) residue[i] -= mode[i];
    }
}

bool EmdWorkspace::sift_out_mode(const StoppingRule& stopping, FinishRule finish,
                                 std::span<double> mode) noexcept {
    const int limit = sift_limit(stopping);
    const auto* s_number = std::get_if<SNumber>(&stopping);
    Stability stability;
    for (int sift = 0; sift < limit; ++sift) {
        find_extrema(mode, maxima_, minima_);
        const std::size_t extrema = maxima_.extrema_count() + minima_.extrema_count();
        if (sift == 0 && finish == FinishRule::at_most_two_extrema && extrema <= 2) return false;
        if (s_number != nullptr) {
            stability.observe(maxima_.extrema_count(), minima_.extrema_count());
            if (stability.repeats() >= s_number->repeats && has_extrema_of_correct_sign()) break;
        }
        subtract_mean_envelope(mode);
    }
    return true;
}

void EmdWorkspace::subtract_mean_envelope(std::span<double> curve) noexcept {
    add_end_knots(curve, maxima_, minima_);
    double* const upper = envelope_.data();
    spline_.fit(maxima_.positions(), maxima_.values());
    spline_.for_each_sample([upper](std::size_t i, double value) { upper[i] = value; });
    double* const samples = curve.data();
    spline_.fit(minima_.positions(), minima_.values());
    // upper + lower, not one after the other: a signal turned upside down then gives the same bits.
    spline_.for_each_sample(
        [upper, samples](std::size_t i, double lower) { samples[i] -= 0.5 * (upper[i] + lower); });
}

bool EmdWorkspace::has_extrema_of_correct_sign() const noexcept {
    const auto above = maxima_.extrema_values();
    const auto below = minima_.extrema_values();
    return std::all_of(above.begin(), above.end(), [](double value) { return value > 0.0; }) &&
           std::all_of(below.begin(), below.end(), [](double value) { return value < 0.0; });
}

}  // namespace a351::corrector
