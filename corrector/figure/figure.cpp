#include "corrector/figure/figure.hpp"

#include <fmt/core.h>

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {

double round_step(double limit) {
    const double power = std::pow(10.0, std::floor(std::log10(limit)));
    for (const double step : {5.0, 2.0}) {
        if (step * power <= limit) return step * power;
    }
    return power;
}

std::string datum(double value, int decimals) {
    return (std::isfinite(value) ? text::fixed(value, decimals) : "NaN") + ' ';
}

std::string FigureData::add(const std::string& title, const std::string& lines) {
    if (lines.empty()) return {};
    text_ += fmt::format("{}# {}\n{}", count_ > 0 ? "\n\n" : "", title, lines);
    return fmt::format("'{}.dat' index {}", name_, count_++);
}

Figure FigureData::figure(const std::string& caption, int width_px, int height_px,
                          const std::string& body) const {
    constexpr double kPixelsPerInch = 96.0;
    constexpr int kSmallWidth_px = 480;
    // PNG has three times the size.  The scales make letters and marks of all formats look alike.
    const std::string script = fmt::format(
        "# gnuplot {0}.gp writes {0}.svg; gnuplot -e \"format='pdf'\" {0}.gp a PDF (or 'png')\n"
        "reset\n"
        "if (!exists('format')) format = 'svg'\n"
        "if (format eq 'svg') set terminal svg noenhanced size {1},{2} font 'sans-serif,13'\n"
        "if (format eq 'pdf') set terminal pdfcairo noenhanced size {3}in,{4}in font "
        "'sans-serif,13' fontscale 0.56 pointscale 1.05\n"
        "if (format eq 'png') set terminal pngcairo noenhanced size {5},{6} font "
        "'sans-serif,13' fontscale 2.25 linewidth 3 pointscale 4.2\n"
        "set encoding utf8\n"
        "set output '{0}.'.format\n"
        "set border 15 lw 0.8\n"
        "set tics in scale 0.6\n"
        "set key tmargin left vertical maxrows 3 reverse Left samplen 2\n"
        "set grid lc rgb '#dddddd' lt 1 lw 0.6\n"
        "{7}unset output\n",
        name_, width_px, height_px, text::fixed(width_px / kPixelsPerInch, 3),
        text::fixed(height_px / kPixelsPerInch, 3), 3 * width_px, 3 * height_px, body);
    return {name_, caption, script, text_, width_px <= kSmallWidth_px};
}

std::string plot_command(const std::vector<std::string>& clauses) {
    return fmt::format("plot {}\n", text::joined(clauses, ", \\\n     "));
}

}  // namespace a351::corrector::figure
