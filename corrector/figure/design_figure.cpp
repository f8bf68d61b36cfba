#include "corrector/figure/design_figure.hpp"

#include <array>

#include "corrector/figure/escaping.hpp"
#include "corrector/whole_day/day_fit.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {

Figure design_figure(const design::ExpectedErrors& errors, const Print& print) {
    // Sources in the order of whole_day::ErrorSource.
    constexpr std::array<std::pair<const char*, Colour>, whole_day::kErrorSources> kParts{
        {{"placement", Colour::blue},
         {"flicker", Colour::sky},
         {"white noise", Colour::grey},
         {"levelling", Colour::purple},
         {"temperature", Colour::vermilion},
         {"drift", Colour::orange},
         {"datum", Colour::green},
         {"scale", Colour::black}}};
    Figure figure{"design",
                  "Expected variance of the unknown stations and its sources; above each bar: "
                  "station and standard uncertainty in mGal.",
                  print.wide_mm(),
                  {{.x = {.is_shown = false},
                    .y = {"Variance (mGal²)", {0.0, kFromData}},
                    .has_margin = true,
                    .height_mm = kWidePanel_mm}}};
    Panel& panel = figure.panels.front();
    std::string lines;
    double place = 0.0;
    for (const design::ExpectedStation& station : errors.stations) {
        if (station.is_known) continue;
        lines += data_line("03", {place, station.u.value()}, "");
        // A bar ends where the variances of its source and of those below it add up to.
        double sum = 0.0;
        for (const double part : station.parts_mgal)
            lines += data_line("4", {sum += part * part}, "");
        lines += "# " + clean_utf8(station.site) + '\n';
        panel.names.emplace_back(
            place, short_label(station.site) + ' ' + text::fixed(station.u.value(), 2));
        place += 1.0;
    }
    panel.x.range = {-0.6, place - 0.4};
    const std::string source = figure.add(
        "number u_mgal, then sums of variances in mGal^2: placement flicker white levelling "
        "thermal drift datum",
        lines);
    int column = 2 + static_cast<int>(kParts.size());
    for (auto part = kParts.rbegin(); part != kParts.rend(); ++part, --column)  // highest bar first
        panel.series.push_back({Look::boxes, part->second, part->first, {1, column}, source});
    return figure;
}

}  // namespace a351::corrector::figure
