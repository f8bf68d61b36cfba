#include "corrector/long_record/record_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "corrector/reading/band_pass.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

constexpr double kMostSplit = 0.2;  // largest energy of a neighbour, share of the mode's own

eemd::Result decompose(const std::vector<double>& values, const RecordAnalysisOptions& options,
                       std::size_t before) {
    eemd::Options eemd_options;
    eemd_options.ensemble_size = options.ensemble_size;
    eemd_options.seed = options.seed;
    eemd_options.threads = options.threads;
    eemd_options.progress = [&](std::size_t done, std::size_t members) {
        if (options.progress) options.progress(before + done, 2 * members);
    };
    return eemd::eemd(values, eemd_options);
}

/// Returns the mode that is asked for if it oscillates, or the one whose mean period is nearest to
/// the cycle, by ratio, and within an octave of it.
std::optional<ChosenMode> choose_mode(const eemd::Result& result,
                                      const RecordAnalysisOptions& options, double step_s) {
    const double cycle_s = options.cycle_s;
    const auto distance = [&](const eemd::Component& mode) {
        return mode.extrema_count == 0
                   ? std::numeric_limits<double>::infinity()
                   : std::abs(std::log2(mode.mean_period_samples * step_s / cycle_s));
    };
    const auto& modes = result.modes;
    const auto best = options.mode ? modes.begin() + *options.mode - 1
                                   : std::ranges::min_element(modes, {}, distance);
    if (best == modes.end() || distance(*best) > (options.mode ? 1e6 : 1.0)) return std::nullopt;
    ChosenMode chosen;
    chosen.number = static_cast<std::size_t>(best - modes.begin()) + 1;
    chosen.period_s = best->mean_period_samples * step_s;
    chosen.energy_share = best->energy_share;
    const auto add_neighbour = [&](const eemd::Component& neighbour) {
        if (best->energy_share > 0.0)
            chosen.neighbour_share =
                std::max(chosen.neighbour_share, neighbour.energy_share / best->energy_share);
    };
    if (best != modes.begin()) add_neighbour(*(best - 1));
    if (best + 1 != modes.end()) add_neighbour(*(best + 1));
    return chosen;
}

/// Returns causal_reading(), but only if a part of the band shows a response above chance.
text::Message reading_of(const RecordAnalysis& analysis, double cycle_s) {
    const ResponsePoint* at_cycle = nullptr;
    for (const ResponsePoint& point : analysis.by_spectrum) {
        const bool is_in_band = point.period_s > shortest_of_band_s(cycle_s) &&
                                point.period_s < longest_of_band_s(cycle_s);
        if (is_in_band && point.refusal.empty()) return causal_reading(analysis.band);
        if (point.shortest_s <= cycle_s && cycle_s <= point.longest_s) at_cycle = &point;
    }
    return text::message(
        "In the band of {} s this record shows no response{}. The statistics of band and modes "
        "have no meaning here.",
        text::fixed(cycle_s, 0),
        at_cycle == nullptr
            ? text::Message()
            : text::message(" ({}); needed: {}", at_cycle->refusal, at_cycle->needed));
}

double change_of(const std::vector<double>& values) { return values.back() - values.front(); }

void remark_on_mode(RecordAnalysis& analysis, const std::optional<ChosenMode>& mode,
                    const text::Message& name, const RecordAnalysisOptions& options) {
    if (!mode && options.mode)
        analysis.remarks.push_back(text::message(
            "{}: mode {} does not oscillate; needed: a longer record", name, *options.mode));
    else if (!mode)
        analysis.remarks.push_back(text::message(
            "{}: no mode has a mean period within an octave of {} s; needed: a record "
            "in which the oven cycles",
            name, text::fixed(options.cycle_s, 0)));
    else if (mode->neighbour_share > kMostSplit)
        analysis.remarks.push_back(text::message(
            "{}: a neighbour of mode {} ({} s) has {} % of its energy: the oscillation "
            "may be split between both modes",
            name, mode->number, text::fixed(mode->period_s, 0),
            text::fixed(100.0 * mode->neighbour_share, 0)));
}

void remark_on_trend(RecordAnalysis& analysis, double record_s) {
    constexpr double kLeast_s = 6.0 * kSecondsPerHour;
    if (record_s < kLeast_s)
        analysis.remarks.push_back(
            text::message("trend: {} h are too short to show a trend; needed: 12 h or more",
                          text::fixed(record_s / kSecondsPerHour, 1)));
    if (!analysis.two_paths[TwoPathTerm::warm_up].is_determined ||
        !analysis.two_paths[TwoPathTerm::drift].is_determined)
        analysis.remarks.push_back(text::message(
            "trend: this record does not separate warm-up, drift and slow temperature; needed: one "
            "from power-on, or one over days in which the temperature moves up and down"));
}

}  // namespace

std::size_t least_record_length(double cycle_s, double step_s) {
    constexpr double kCycles = 8.0;
    return static_cast<std::size_t>(std::ceil(kCycles * cycle_s / step_s));
}

RecordAnalysis analyse_record(const RecordSegment& segment, double step_s,
                              const RecordAnalysisOptions& options) {
    if (segment.size() < least_record_length(options.cycle_s, step_s))
        throw std::invalid_argument("analyse_record: segment shorter than eight cycles");
    const std::vector<double>& temperature = segment.temperature_degc;
    // Minus the first sample, to keep the last digits: the norm is near a million mGal.
    std::vector<double> acceleration = segment.quantity;
    for (double& value : acceleration) value -= segment.quantity.front();

    RecordAnalysis analysis;
    analysis.step_s = step_s;
    const auto correlated = static_cast<std::size_t>(4.0 * options.cycle_s / step_s);
    analysis.raw = signal::fit_line(temperature, acceleration, correlated);
    analysis.noise = noise::record_noise(acceleration, step_s);
    analysis.raw.mean_y += segment.quantity.front();

    const double shortest_s = shortest_of_band_s(options.cycle_s),
                 longest_s = longest_of_band_s(options.cycle_s);
    analysis.band = pair_statistics(reading::band_pass(temperature, step_s, shortest_s, longest_s),
                                    reading::band_pass(acceleration, step_s, shortest_s, longest_s),
                                    step_s, options.cycle_s, options.shift_s);

    analysis.temperature = decompose(temperature, options, 0);
    analysis.acceleration =
        decompose(acceleration, options, static_cast<std::size_t>(options.ensemble_size));
    const std::vector<double>&slow_temperature = analysis.temperature.residue.values,
          &slow_acceleration = analysis.acceleration.residue.values;
    analysis.trend =
        signal::fit_line(slow_temperature, slow_acceleration, slow_temperature.size() / 4);
    analysis.temperature_change_degc = change_of(slow_temperature);
    analysis.acceleration_change_mgal = change_of(slow_acceleration);

    analysis.temperature_mode = choose_mode(analysis.temperature, options, step_s);
    analysis.acceleration_mode = choose_mode(analysis.acceleration, options, step_s);
    remark_on_mode(analysis, analysis.temperature_mode, text::message("temperature"), options);
    remark_on_mode(analysis, analysis.acceleration_mode, text::message("acceleration"), options);
    if (analysis.temperature_mode && analysis.acceleration_mode) {
        // Another mode has its own cycle; eight of them, and the delay, must fit into the record.
        const double most_s = static_cast<double>(segment.size()) * step_s / 8.0;
        const double cycle_s =
            options.mode ? std::clamp(analysis.temperature_mode->period_s, 4.0 * step_s, most_s)
                         : options.cycle_s;
        analysis.modes = pair_statistics(
            analysis.temperature.modes[analysis.temperature_mode->number - 1].values,
            analysis.acceleration.modes[analysis.acceleration_mode->number - 1].values, step_s,
            cycle_s, options.shift_s);
    }

    analysis.by_spectrum =
        response_by_spectrum(temperature, acceleration, step_s, {.cycle_s = options.cycle_s});
    analysis.reading = reading_of(analysis, options.cycle_s);
    std::vector<std::vector<double>> modes;
    for (const eemd::Component& mode : analysis.temperature.modes)
        if (mode.extrema_count > 0) modes.push_back(mode.values);
    analysis.by_modes = response_by_modes(modes, temperature, acceleration, step_s);
    analysis.two_paths =
        fit_two_paths(temperature, acceleration, step_s, options.cycle_s, segment.outer_degc);
    remark_on_trend(analysis, static_cast<double>(segment.size()) * step_s);
    return analysis;
}

}  // namespace a351::corrector::long_record
