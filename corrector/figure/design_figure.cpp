#include "corrector/figure/design_figure.hpp"

#include <fmt/core.h>

#include "corrector/figure/escaping.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {
namespace {

struct Part {
    std::string_view title;
    std::string colour;
};

/// Sources in the order of whole_day::ErrorSource; further colours of Okabe and Ito.
const std::array<Part, whole_day::kErrorSources>& parts() {
    static const std::array<Part, whole_day::kErrorSources> all{{{"placement", kBlue},
                                                                 {"flicker", "'#56B4E9'"},
                                                                 {"white noise", kGrey},
                                                                 {"levelling", "'#CC79A7'"},
                                                                 {"temperature", kVermilion},
                                                                 {"drift", "'#E69F00'"},
                                                                 {"datum", "'#009E73'"},
                                                                 {"scale", "'#000000'"}}};
    return all;
}

}  // namespace

Figure design_figure(const design::ExpectedErrors& errors) {
    std::string lines, names;
    int count = 0;
    for (const design::ExpectedStation& station : errors.stations) {
        if (station.is_known) continue;
        lines += fmt::format("{} {}", count, datum(station.u.value(), 3));
        // A bar ends where the variances of its source and of those below it add up to.
        double sum = 0.0;
        for (const double part : station.parts_mgal) lines += datum(sum += part * part, 4);
        lines += "# " + clean_utf8(station.site) + '\n';
        names += fmt::format("{}{} {}", count == 0 ? "" : ", ",
                             gnuplot_string(short_label(station.site)), count);
        ++count;
    }
    FigureData data("design");
    const std::string source = data.add(
        "number u_mgal, then sums of variances in mGal^2: placement flicker white levelling "
        "thermal "
        "drift datum",
        lines);
    std::vector<std::string> clauses;
    for (std::size_t k = parts().size(); k-- > 0;)  // the highest bars first
        clauses.push_back(fmt::format("{} using 1:{} with boxes lc rgb {} title '{}'", source,
                                      k + 3, parts().at(k).colour, parts().at(k).title));
    clauses.push_back(fmt::format(
        "{} using 1:{}:(sprintf('%.2f', $2)) with labels offset 0,0.7 font ',11' notitle", source,
        parts().size() + 2));
    return data.figure(
        "Expected variance of the unknown stations and its sources; above each bar: standard "
        "uncertainty in mGal.",
        900, 430,
        fmt::format(
            "set style fill solid\nset boxwidth 0.7\nset xrange [-0.6:{}]\n"
            "set yrange [0:*]\nset offsets 0, 0, graph 0.08, 0\nset xtics rotate by 45 right ({})\n"
            "set ylabel 'Variance (mGal²)'\nset grid noxtics ytics\n{}",
            text::fixed(count - 0.4, 1), names, plot_command(clauses)));
}

}  // namespace a351::corrector::figure
