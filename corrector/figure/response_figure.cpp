#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "corrector/figure/long_record_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

std::string point_lines(const std::vector<long_record::ResponsePoint>& points) {
    std::string lines;
    for (const long_record::ResponsePoint& point : points) {
        if (!point.refusal.empty()) continue;
        lines += datum(point.period_s, 1) + datum(point.gain.value, 2) + datum(point.gain.low, 2) +
                 datum(point.gain.high, 2) + datum(point.phase_deg.value, 2) +
                 datum(point.phase_deg.low, 2) + datum(point.phase_deg.high, 2) + '\n';
    }
    return lines;
}

using Parameters = std::array<double, long_record::kTwoPathTerms>;

double at(const Parameters& parameters, long_record::TwoPathTerm term) {
    return parameters.at(static_cast<std::size_t>(term));
}

/// Returns the logarithm of the fit's transfer function; the lags are given by their logarithms.
std::complex<double> log_response(const Parameters& parameters, double period_s) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi / period_s);
    return std::log(at(parameters, long_record::TwoPathTerm::level) +
                    at(parameters, long_record::TwoPathTerm::fast) * kSecondsPerHour * s /
                        (1.0 + s * std::exp(at(parameters, long_record::TwoPathTerm::fast_lag))) +
                    at(parameters, long_record::TwoPathTerm::slow) /
                        (1.0 + s * std::exp(at(parameters, long_record::TwoPathTerm::slow_lag))));
}

/// Returns period, gain, its 95 % limits, phase, its 95 % limits; the limits are linearised.
std::string fit_line(const long_record::TwoPathFit& fit, double period_s) {
    Parameters parameters{};
    for (std::size_t k = 0; k < long_record::kTwoPathTerms; ++k)
        parameters.at(k) = fit.parameters.at(k).value;
    for (const long_record::TwoPathTerm lag :
         {long_record::TwoPathTerm::fast_lag, long_record::TwoPathTerm::slow_lag,
          long_record::TwoPathTerm::warm_up_time}) {
        double& value = parameters.at(static_cast<std::size_t>(lag));
        value = std::log(value);
    }
    const std::complex<double> here = log_response(parameters, period_s);
    Eigen::VectorXcd slope(static_cast<Eigen::Index>(long_record::kTwoPathTerms));
    for (std::size_t k = 0; k < long_record::kTwoPathTerms; ++k) {
        constexpr double kStep = 1e-4;
        Parameters more = parameters;
        more.at(k) += kStep;
        slope(static_cast<Eigen::Index>(k)) = (log_response(more, period_s) - here) / kStep;
    }
    constexpr double kNormal95 = 1.96;
    const auto half_width = [&](const Eigen::VectorXd& of) {
        return kNormal95 * std::sqrt(of.dot(fit.covariance * of));
    };
    const double factor = std::exp(half_width(slope.real()));
    const double gain = std::exp(here.real()), phase = here.imag() * kDegPerRad;
    const double width = std::min(half_width(slope.imag()) * kDegPerRad, 180.0);
    return datum(period_s, 1) + datum(gain, 3) + datum(gain / factor, 3) + datum(gain * factor, 3) +
           datum(phase, 2) + datum(phase - width, 2) + datum(phase + width, 2) + '\n';
}

/// Returns the lines of the fit from its shortest period to the length of the record.
std::string fit_lines(const long_record::RecordResult& result) {
    constexpr double kShortest_s = 240.0, kStep = 1.05;
    const double longest_s = static_cast<double>(result.segment().size()) * result.record.step_s;
    std::string lines;
    for (double period_s = kShortest_s; period_s < longest_s; period_s *= kStep)
        lines += fit_line(result.analysis.two_paths, period_s);
    return lines;
}

}  // namespace

Figure response_figure(const long_record::RecordResult& result) {
    FigureData data("response");
    std::vector<std::string> gain, phase;
    const auto add = [&](const std::vector<long_record::ResponsePoint>& points,
                         const std::string& style, const std::string& title) {
        const std::string source =
            data.add(title + ": period_s gain low high phase_deg low high", point_lines(points));
        if (source.empty()) return;
        gain.push_back(fmt::format("{} using 1:2:3:4 with yerrorbars {} title '{}'", source, style,
                                   text::translated(title, text::language())));
        phase.push_back(fmt::format("{} using 1:5:6:7 with yerrorbars {} notitle", source, style));
    };
    add(result.analysis.by_spectrum, "pt 7 ps 0.6 lc rgb " + kBlue, text::marked("by spectrum"));
    add(result.analysis.by_modes, "pt 6 ps 0.8 lw 1.2 lc rgb " + kVermilion,
        text::marked("by modes"));
    const std::string fit =
        data.add("two-path fit: period_s gain low high phase_deg low high", fit_lines(result));
    const std::string line = " with lines lw 1.2 lc rgb " + kGrey;
    gain.insert(gain.begin(),
                {fit + " using 1:3:4 with filledcurves lc rgb '#e4e4e4' notitle",
                 fit + " using 1:2" + line + " title '" + text::tr("two-path fit") + "'"});
    phase.insert(phase.begin(), {fit + " using 1:6:7 with filledcurves lc rgb '#e4e4e4' notitle",
                                 fit + " using 1:5" + line + " notitle"});
    return data.figure(
        text::tr("Gain and phase of the acceleration against the temperature by period, with "
                 "limits of 95 %."),
        900, 560,
        fmt::format("set multiplot layout 2,1\nset logscale x\nset lmargin 12\n"
                    "set xrange [100:*]\nset yrange [1:3000]\nset ylabel '{}'\n"
                    "set logscale y\n{}unset logscale y\nset yrange [-200:200]\nset ytics 90\n"
                    "set ylabel '{}'\nset xlabel '{}'\n{}unset multiplot\n",
                    text::tr("Gain (mGal/°C)"), plot_command(gain), text::tr("Phase (°)"),
                    text::tr("Period (s)"), plot_command(phase)));
}

}  // namespace a351::corrector::figure
