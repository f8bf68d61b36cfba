#include "corrector/figure/time_axis.hpp"

#include <chrono>

#include "corrector/figure/escaping.hpp"

namespace a351::corrector {

std::string time_axis(const std::vector<CorrectedRow>& rows) {
    std::string names;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const SurveyRow& row = rows[i].row;
        const bool is_further_set_up = i > 0 && rows[i - 1].row.site == row.site &&
                                       rows[i - 1].row.occupation == row.occupation;
        if (is_further_set_up) continue;
        names +=
            (i == 0 ? "" : ", \\\n    ") +
            gnuplot_string(short_label(row.site) + " (" + std::to_string(row.occupation) + ")") +
            " '" + to_rfc3339(row.time) + "'";
    }
    // Longest survey whose axis shows only hours; a longer one needs the date too.
    constexpr std::chrono::hours kLongestDay(36);
    const UtcTime first = rows.front().row.time;
    const UtcTime last = rows.back().row.time;
    const std::string first_date = to_rfc3339(first).substr(0, 10);
    const std::string last_date = to_rfc3339(last).substr(0, 10);
    return std::string("set xdata time\nset x2data time\nset timefmt '%Y-%m-%dT%H:%M:%SZ'\n") +
           (last - first > kLongestDay ? "set format x \"%H:%M\\n%m-%d\"\n"
                                       : "set format x '%H:%M'\n") +
           "set link x2\nset xlabel 'UTC, " + first_date +
           (first_date == last_date ? "" : " to " + last_date) +
           "'\nset xtics nomirror\nset grid x2tics noxtics\n"
           "set x2tics scale 0 rotate by 90 left font ',10' (" +
           names + ")\n";
}

}  // namespace a351::corrector
