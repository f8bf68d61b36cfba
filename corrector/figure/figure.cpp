#include "corrector/figure/figure.hpp"

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {

std::string script_head(const std::string& name, int width_px, int height_px) {
    constexpr double kPixelsPerInch = 96.0;
    const std::string inches = text::fixed(width_px / kPixelsPerInch, 3) + "in," +
                               text::fixed(height_px / kPixelsPerInch, 3) + "in";
    const std::string pixels = std::to_string(width_px) + "," + std::to_string(height_px);
    // PNG has three times the size.  The scales make letters and marks of all formats look alike.
    const std::string tripled = std::to_string(3 * width_px) + "," + std::to_string(3 * height_px);
    return "# gnuplot " + name + ".gp writes " + name + ".svg; gnuplot -e \"format='pdf'\" " +
           name +
           ".gp a PDF (or 'png')\n"
           "reset\n"
           "if (!exists('format')) format = 'svg'\n"
           "if (format eq 'svg') set terminal svg noenhanced size " +
           pixels +
           " font 'sans-serif,13'\n"
           "if (format eq 'pdf') set terminal pdfcairo noenhanced size " +
           inches +
           " font 'sans-serif,13' fontscale 0.56 pointscale 1.05\n"
           "if (format eq 'png') set terminal pngcairo noenhanced size " +
           tripled +
           " font 'sans-serif,13' fontscale 2.25 linewidth 3 pointscale 4.2\n"
           "set encoding utf8\n"
           "set output '" +
           name +
           ".'.format\n"
           "set border 15 lw 0.8\n"
           "set tics in scale 0.6\n"
           "set key tmargin left vertical maxrows 3 reverse Left samplen 2\n"
           "set grid lc rgb '#dddddd' lt 1 lw 0.6\n";
}

std::string script_tail() { return "unset output\n"; }

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

std::optional<int> DataBlocks::add(const std::string& title, const std::string& lines) {
    if (lines.empty()) return std::nullopt;
    if (count_ > 0) text_ += "\n\n";
    text_ += "# " + title + '\n' + lines;
    return count_++;
}

std::string block_clause(const std::string& name, std::optional<int> block,
                         const std::string& rest) {
    return "'" + name + ".dat' index " + std::to_string(block.value()) + ' ' + rest;
}

std::string plot_command(const std::vector<std::string>& clauses) {
    std::string command = "plot ";
    for (std::size_t i = 0; i < clauses.size(); ++i) {
        command += (i == 0 ? "" : ", \\\n     ") + clauses[i];
    }
    return command + '\n';
}

}  // namespace a351::corrector
