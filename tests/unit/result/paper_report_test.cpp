#include "corrector/result/paper_report.hpp"

#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "corrector/result/table_text.hpp"
#include "tests/golden/tsukuba_table.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::model;
using namespace a351::corrector::result;

TEST_CASE("Table 2 of the publication comes out with its columns, errors and their rms") {
    const SurveyCorrection result =
        correct_survey(tsukuba::with_recovered_temperature(), {.model = "paper"});
    REQUIRE(is_paper(result));
    const Table table = paper_table(result);
    CHECK(table.headings == std::vector<std::string>{"Site", "Occ.", "Reference", "Time UTC",
                                                     "Tide", "Acceleration", "T degC", "Difference",
                                                     "Corrected (1)", "Error (1)", "Corrected (2)",
                                                     "Error (2)", "In fit"});
    REQUIRE(table.rows.size() == 19);
    std::size_t column = 7;
    for (const char* const name :
         {"difference_mgal", "corrected1_mgal", "error1_mgal", "corrected2_mgal", "error2_mgal"}) {
        const std::vector<double> printed = tsukuba::printed(name);
        for (std::size_t i = 0; i < printed.size(); ++i) {
            CAPTURE(name, i);
            // The publication rounds its line to 3085.2 mGal, which moves all values by 0.04.
            // Slip of the publication: -1.022 for -1.002 (tests/golden/tsukuba/README.md).
            const bool is_slip = i == 2 && column == 9;
            CHECK(std::stod(table.rows[i].at(column)) ==
                  Approx(is_slip ? -1.002 : printed[i]).epsilon(0).margin(0.05));
        }
        ++column;
    }
    // Of the printed errors, without the slip: 2.0004 and 2.5926.
    CHECK_THAT(paper_errors(result),
               ContainsSubstring("Error (1) 2.000 mGal, Error (2) 2.593 mGal"));
    CHECK_THAT(survey_text(result, true),
               ContainsSubstring("Corrected (1)") && ContainsSubstring(paper_errors(result)));
    CHECK_THAT(survey_text(result, false), !ContainsSubstring("Corrected (1)"));
}
