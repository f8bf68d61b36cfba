#include "daemon/verdict/reading_outlook.hpp"

#include <cmath>
#include <utility>

#include "protocol/core/units.hpp"

namespace a351::daemon::verdict {

ReadingOutlook::ReadingOutlook(const Options& options, const OvenFilter& filter)
    : options_(options),
      half_(
          static_cast<std::size_t>(std::lround(0.5 * options.cycle_s / OvenFilter::kStepSeconds))),
      slow_gain_(-std::expm1(-OvenFilter::kStepSeconds / (60.0 * options.slow_lag_min))) {
    for (std::size_t j = 0; j < OvenFilter::kStates; ++j) {
        OvenFilter::State unit{};
        unit[j] = 1.0;
        const std::vector<double> past(half_ + 1, 0.0);
        const Changes one = changes(continued(past, unit, filter), 0.0);
        for (std::size_t i = 0; i < one.size(); ++i) by_state_[i][j] = one[i];

        // The noise of a later step acts from that step on.
        const double variance = filter.unrest(j);
        std::vector<double> later = past;
        while (variance > 0.0 && later.size() < 2 * half_ + kAhead + 1) {
            std::vector<double> kicked = later;
            kicked.push_back(OvenFilter::seen(unit));
            const Changes kick = changes(continued(std::move(kicked), unit, filter), 0.0);
            for (std::size_t i = 0; i < kick.size(); ++i)
                unforeseen_mgal2_[i] += variance * kick[i] * kick[i];
            later.push_back(0.0);
        }
    }
}

void ReadingOutlook::clear() {
    past_degc_.clear();
    past_slow_degc_.clear();
}

void ReadingOutlook::take(double degc) {
    const double slow = past_slow_degc_.empty() ? degc : past_slow_degc_.back();
    past_degc_.push_back(degc);
    past_slow_degc_.push_back(slow + slow_gain_ * (degc - slow));
    if (past_degc_.size() <= half_ + 1) return;
    past_degc_.pop_front();
    past_slow_degc_.pop_front();
}

std::vector<double> ReadingOutlook::continued(std::vector<double> degc, OvenFilter::State state,
                                              const OvenFilter& filter) const {
    while (degc.size() < 2 * half_ + kAhead + 1) {
        state = filter.ahead(state);
        degc.push_back(OvenFilter::seen(state));
    }
    return degc;
}

/// Returns the change of the reading at each whole minute ahead.
/// @param degc       temperatures from half a cycle ago on.
/// @param slow_degc  lagged temperature at the first of them.
ReadingOutlook::Changes ReadingOutlook::changes(const std::vector<double>& degc,
                                                double slow_degc) const {
    std::vector<double> weighed;
    for (std::size_t i = 0; i < degc.size(); ++i) {
        if (i > 0) slow_degc += slow_gain_ * (degc[i] - slow_degc);
        weighed.push_back(options_.static_mgal_per_degc * degc[i] +
                          options_.slow_mgal_per_degc * slow_degc);
    }
    const std::size_t whole = 2 * half_;
    const double cycle_h = static_cast<double>(whole) * OvenFilter::kStepSeconds / kSecondsPerHour;
    const auto rise = [&](std::size_t i) { return degc[i + whole] - degc[i]; };
    Changes changes{};
    double sum = 0.0;
    for (std::size_t s = 1; s <= kAhead; ++s) {
        sum += weighed[s + whole] - weighed[s - 1];
        if (s % kEvery != 0) continue;
        changes[s / kEvery - 1] = sum / static_cast<double>(whole + 1) +
                                  options_.rate_mgal_h_per_degc * (rise(s) - rise(0)) / cycle_h;
    }
    return changes;
}

std::optional<Outlook> ReadingOutlook::outlook(const OvenFilter& filter,
                                               double warm_up_mgal) const {
    if (past_degc_.size() <= half_) return std::nullopt;
    const std::vector<double> past(past_degc_.begin(), past_degc_.end());
    const Changes change =
        changes(continued(past, filter.state(), filter), past_slow_degc_.front());
    const double doubt_mgal = options_.doubt_mgal_per_degc * filter.off_level_degc();
    Outlook worst;
    for (std::size_t i = 0; i < change.size(); ++i) {
        const double share = static_cast<double>(i + 1) / static_cast<double>(change.size());
        const double hours = share * kAhead * OvenFilter::kStepSeconds / kSecondsPerHour;
        const double whole = change[i] + warm_up_mgal * std::expm1(-hours / options_.warm_up_h);
        const double error = std::sqrt(filter.variance_of(by_state_[i]) + unforeseen_mgal2_[i] +
                                       share * share * doubt_mgal * doubt_mgal);
        const auto reach = [&](double mgal, double rms) {
            return std::abs(mgal) + options_.sure * rms;
        };
        if (reach(whole, error) > reach(worst.change_mgal, worst.error_mgal))
            worst = {whole, error};
    }
    return worst;
}

}  // namespace a351::daemon::verdict
