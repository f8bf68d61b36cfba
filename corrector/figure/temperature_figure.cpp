#include "corrector/figure/temperature_figure.hpp"

#include <chrono>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/reading_name.hpp"
#include "corrector/figure/time_axis.hpp"

namespace a351::corrector {

Figure temperature_figure(const SurveyCorrection& result,
                          const std::vector<MinuteTemperature>& course) {
    const std::string kName = "temperature";
    std::string course_lines;
    for (std::size_t i = 0; i < course.size(); ++i) {
        const bool is_gap =
            i > 0 && course[i].middle - course[i - 1].middle > std::chrono::minutes(1);
        if (is_gap) course_lines += '\n';
        course_lines +=
            to_rfc3339(course[i].middle) + ' ' + datum(course[i].mean.value(), 4) + '\n';
    }
    std::string reading_lines;
    std::string intervals;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const SurveyRow& row = result.rows[i].row;
        reading_lines += to_rfc3339(row.time) + ' ' + datum(row.temperature.value(), 4) + "# " +
                         clean_utf8(reading_name(result.rows, i)) + '\n';
        if (!row.start || !row.end) continue;
        intervals += "set object rectangle from '" + to_rfc3339(*row.start) + "',graph 0 to '" +
                     to_rfc3339(*row.end) + "',graph 1 fc rgb '#d9ecf7' fs solid noborder behind\n";
    }
    DataBlocks data;
    std::vector<std::string> clauses;
    if (const auto block = data.add("means of a minute: time_utc temperature_degc", course_lines)) {
        clauses.push_back("'" + kName + ".dat' index " + std::to_string(*block) +
                          " using 1:2 with lines lw 1.2 lc rgb " + kVermilion +
                          " title 'means of a minute'");
    }
    const auto block = data.add("readings: time_utc temperature_degc", reading_lines);
    clauses.push_back("'" + kName + ".dat' index " + std::to_string(block.value()) +
                      " using 1:2 with points pt 7 ps 0.6 lc rgb " + kBlue + " title 'readings'");
    return Figure{kName,
                  course.empty()
                      ? "Temperature of the readings."
                      : "Temperature of the sensor over the day; shaded: the averaged intervals.",
                  script_head(kName, 900, 400) + time_axis(result.rows) +
                      "set ylabel 'Temperature (°C)'\n"
                      "set offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05\n" +
                      intervals + plot_command(clauses) + script_tail(),
                  data.text()};
}

}  // namespace a351::corrector
