#include "corrector/report/time_axis.hpp"

#include "corrector/report/escaping.hpp"
#include "corrector/report/reading_name.hpp"

namespace a351::corrector {

std::string time_axis(const std::vector<CorrectedRow>& rows) {
    std::string names;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        names += (i == 0 ? "" : ", \\\n    ") + gnuplot_string(reading_name(rows, i)) + " '" +
                 to_rfc3339(rows[i].row.time) + "'";
    }
    const std::string first = to_rfc3339(rows.front().row.time).substr(0, 10);
    const std::string last = to_rfc3339(rows.back().row.time).substr(0, 10);
    return "set xdata time\nset x2data time\nset timefmt '%Y-%m-%dT%H:%M:%SZ'\n"
           "set format x '%H:%M'\nset link x2\nset xlabel 'UTC, " +
           first + (first == last ? "" : " to " + last) +
           "'\nset xtics nomirror\nset grid x2tics noxtics\n"
           "set x2tics scale 0 rotate by 90 left font ',10' (" +
           names + ")\n";
}

}  // namespace a351::corrector
