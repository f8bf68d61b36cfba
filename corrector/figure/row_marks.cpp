#include "corrector/figure/row_marks.hpp"

#include <fmt/core.h>

#include <array>

#include "corrector/figure/escaping.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {

void plot_rows(Figure& figure, const model::SurveyCorrection& result, const std::string& columns,
               const std::function<std::string(const model::CorrectedRow&)>& line_of) {
    constexpr std::array kKinds{text::marked("in the fit"),
                                text::marked("marked by the operator, in the fit"),
                                text::marked("left out of the fit")};
    const std::array<Series, kKinds.size()> looks{{{Look::discs, Colour::blue},
                                                   {Look::diamonds, Colour::orange},
                                                   {Look::crosses, Colour::vermilion}}};
    std::array<std::string, kKinds.size()> lines;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const model::CorrectedRow& row = result.rows[i];
        const std::string line = line_of(row);
        if (!line.empty())
            lines.at(!row.is_used ? 2 : row.row.is_flagged ? 1 : 0) += line + comment(result, i);
    }
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
        Series series = looks.at(k);
        series.label = text::translated(kKinds.at(k));
        figure.plot(fmt::format("{}: {}", kKinds.at(k), columns), lines.at(k), series);
    }
}

void add_bars(Panel& panel) {
    std::vector<Series> bars;
    for (const Series& marks : panel.series)
        bars.push_back({Look::bars, Colour::bar_grey, "", {1, 2, 3}, marks.source});
    panel.series.insert(panel.series.begin(), bars.begin(), bars.end());
}

std::string comment(const model::SurveyCorrection& result, std::size_t row) {
    return fmt::format("# {}\n", clean_utf8(judgement::reading_name(result.rows, row)));
}

}  // namespace a351::corrector::figure
