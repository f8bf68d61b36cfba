#include "corrector/figure/history_figure.hpp"

#include "corrector/figure/gnuplot_script.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;

TEST_CASE("the terms of a unit by day have a panel each, if a day has them") {
    std::vector<result::UnitDay> days(2);
    for (std::size_t k = 0; k < days.size(); ++k) {
        days[k].serial_number = "A";
        days[k].start =
            parse_rfc3339(k == 0 ? "2026-05-02T01:00:00Z" : "2026-06-02T01:00:00Z").value();
        days[k].terms.resize(result::term_kinds().size());
        days[k].terms.front() =
            model::Coefficient{"constant_mgal", 11.0 + 2.0 * static_cast<double>(k), 2.0};
    }
    const figure::Figure figure = figure::history_figure(days, {});
    CHECK_THAT(figure.data, ContainsSubstring("2026-06-02T01:00:00Z 13.00000 2.00000"));
    // A date in two lines has room at the border.
    CHECK_THAT(figure::script_of(figure), ContainsSubstring("set format x '%m-%d'.\"\\n\".'%Y'"));
    CHECK_THAT(figure::script_of(figure), ContainsSubstring("Constant mGal"));
    CHECK_THAT(figure::script_of(figure), !ContainsSubstring("Placement mGal"));  // No day has it.
    CHECK_THAT(
        figure::script_of(figure),
        ContainsSubstring("set xtics nomirror norotate 604800"));  // 31 days in at most 6 dates.
}
