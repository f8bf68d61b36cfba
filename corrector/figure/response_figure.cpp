#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "corrector/figure/long_record_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using long_record::TwoPathTerm;
using text::tr;
using Parameters = std::array<double, long_record::kTwoPathTerms>;

/// Returns the logarithm of the fit's transfer function; the lags are given by their logarithms.
std::complex<double> log_response(const Parameters& parameters, double period_s) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi / period_s);
    const auto at = [&](TwoPathTerm term) { return parameters.at(static_cast<std::size_t>(term)); };
    return std::log(at(TwoPathTerm::level) +
                    at(TwoPathTerm::fast) * kSecondsPerHour * s /
                        (1.0 + s * std::exp(at(TwoPathTerm::fast_lag))) +
                    at(TwoPathTerm::slow) / (1.0 + s * std::exp(at(TwoPathTerm::slow_lag))));
}

/// Returns period, gain, its 95 % limits, phase, its 95 % limits; the limits are linearised.
std::string fit_line(const long_record::TwoPathFit& fit, double period_s) {
    Parameters parameters{};
    for (std::size_t k = 0; k < parameters.size(); ++k)
        parameters.at(k) = fit.parameters.at(k).value;
    for (const TwoPathTerm lag :
         {TwoPathTerm::fast_lag, TwoPathTerm::slow_lag, TwoPathTerm::warm_up_time})
        parameters.at(static_cast<std::size_t>(lag)) = std::log(fit[lag].value);
    const std::complex<double> here = log_response(parameters, period_s);
    Eigen::VectorXcd slope(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        constexpr double kStep = 1e-4;
        Parameters more = parameters;
        more.at(k) += kStep;
        slope(static_cast<Eigen::Index>(k)) = (log_response(more, period_s) - here) / kStep;
    }
    const auto half_width = [&](const Eigen::VectorXd& of) {
        return signal::kNormal95 * std::sqrt(of.dot(fit.covariance * of));
    };
    const double factor = std::exp(half_width(slope.real()));
    const double gain = std::exp(here.real()), phase = here.imag() * kDegPerRad;
    const double width = std::min(half_width(slope.imag()) * kDegPerRad, 180.0);
    return data_line("1333222", {period_s, gain, gain / factor, gain * factor, phase, phase - width,
                                 phase + width});
}

}  // namespace

Figure response_figure(const long_record::RecordResult& result, const Print& print) {
    Figure figure{"response",
                  tr("Gain and phase of the acceleration against the temperature by period, with "
                     "limits of 95 %."),
                  print.wide_mm()};
    const double longest_s = static_cast<double>(result.segment().size()) * result.record.step_s;
    const Axis period{.range = {100.0, longest_s}, .scale = Scale::logarithmic};
    Panel gain{
        period,
        {.label = tr("Gain (mGal/°C)"), .range = {1.0, 3000.0}, .scale = Scale::logarithmic}};
    Panel phase{period, {tr("Phase (°)"), {-200.0, 200.0}, 90.0}};
    gain.height_mm = phase.height_mm = kStackedPanel_mm;
    phase.x.label = tr("Period (s)");

    const auto points = [&figure](const std::string& title,
                                  const std::vector<long_record::ResponsePoint>& all) {
        std::string lines;
        for (const long_record::ResponsePoint& point : all)
            if (point.refusal.empty())
                lines += data_line(
                    "1222222", {point.period_s, point.gain.value, point.gain.low, point.gain.high,
                                point.phase_deg.value, point.phase_deg.low, point.phase_deg.high});
        return figure.add(title + ": period_s gain low high phase_deg low high", lines);
    };
    const std::string by_spectrum = points("by spectrum", result.analysis.by_spectrum);
    const std::string by_modes = points("by modes", result.analysis.by_modes);
    constexpr double kShortest_s = 240.0, kStep = 1.05;
    std::string lines;
    for (double period_s = kShortest_s; period_s < longest_s; period_s *= kStep)
        lines += fit_line(result.analysis.two_paths, period_s);
    const std::string fit =
        figure.add("two-path fit: period_s gain low high phase_deg low high", lines);

    const auto plot = [&](const std::string& source, std::vector<int> columns, Look look,
                          Colour colour, const std::string& label) {
        gain.series.push_back({look, colour, label, columns, source});
        for (int& column : columns) column += column > 1 ? 3 : 0;
        phase.series.push_back({look, colour, "", columns, source});
    };
    const std::vector<int> all{1, 2, 3, 4};
    plot(fit, {1, 3, 4}, Look::area, Colour::limits, "");
    plot(fit, {1, 2}, Look::line, Colour::grey, tr("two-path fit"));
    plot(by_spectrum, all, Look::discs_with_bars, Colour::blue, tr("by spectrum"));
    plot(by_modes, all, Look::circles_with_bars, Colour::vermilion, tr("by modes"));
    figure.panels = {gain, phase};
    return figure;
}

}  // namespace a351::corrector::figure
