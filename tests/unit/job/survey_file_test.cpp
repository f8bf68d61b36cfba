#include "corrector/job/survey_file.hpp"

#include "tests/support/catch.hpp"

#include "corrector/reading/representative_value.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::job;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// A folder with a data root and two sites.
struct Desk {
    test::TemporaryDirectory folder;

    Desk() {
        folder.write("data/metadata/station.xml", "");
        folder.write("sites.csv",
                     "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                     "No.0,140.1,36.2,532,979860.21\nNo.1,140.0,36.1,185,\n");
    }
    [[nodiscard]] SurveyFile read(const std::string& toml) const {
        return read_survey_file(folder.write("day.toml", toml));
    }
};

}  // namespace

TEST_CASE("a survey file names the readings of a reference gravimeter") {
    const Desk desk;
    desk.folder.write("meter.csv", "");
    const SurveyFile survey = desk.read(
        "[survey]\n[reference]\nobservations = \"meter.csv\"\nreading_sd_mgal = 0.02\n"
        "drift_degree = 2\nscale = [1.001, 1e-5]\n");
    REQUIRE(survey.reference);
    CHECK(survey.reference->observations == desk.folder.path() / "meter.csv");
    CHECK(survey.reference->priors.reading_sd_mgal == 0.02);
    CHECK(survey.reference->network.drift_degree == 2);
    CHECK(survey.reference->priors.scale_of("B44").mean == 1.001);
    CHECK_FALSE(desk.read("[survey]\n").reference);
    for (const std::string refused :
         {"", "observations = \"no.csv\"\n", "observations = \"meter.csv\"\nscale = [1]\n",
          "observations = \"meter.csv\"\nscale = [1.5, 0.01]\n",
          "observations = \"meter.csv\"\nother = 1\n"}) {
        INFO(refused);
        CHECK_THROWS_AS(desk.read("[survey]\n[reference]\n" + refused), InputError);
    }
}

TEST_CASE("an empty survey file has the documented defaults") {
    const Desk desk;
    const SurveyFile survey = desk.read("[survey]\n");
    CHECK(survey.name == "day");
    CHECK(survey.root == desk.folder.path() / "data");
    CHECK(survey.sites == desk.folder.path() / "sites.csv");
    CHECK(survey.occupations.empty());
    CHECK(survey.survey.model == "auto");
    CHECK(survey.survey.use_flags);
    CHECK(survey.tide.source == "direct");
    CHECK(survey.tide.factors.delta2 == 1.16);
    CHECK(survey.tide.factors.delta3 == 1.07);
    CHECK(survey.averaging.norm == NormOrder::decimate_first);
    CHECK(survey.survey.seed == 1);
    CHECK(survey.averaging.trend == TrendMethod::eemd);
    CHECK(survey.averaging.cutoff_s == RepresentativeOptions().cutoff_s);
}

TEST_CASE("every key of a survey file is read") {
    const Desk desk;
    const SurveyFile survey = desk.read(
        "[survey]\nname='first'\nroot='data'\nsites='sites.csv'\noccupations='o.csv'\n"
        "base='No.0'\ndatum=['No.0','No.1']\nmodel='t-rate'\nflags='ignore'\ntide='longman'\n"
        "delta2=1.2\ndelta3=1.2\ncalibration=''\nseed=9\nnorm='as-published'\n"
        "trend='smoother'\ncutoff_s=240\n"
        "pressure_channel='XX.BARO..LDI'\npressure_counts_per_hpa=10\n");
    CHECK(survey.name == "first");
    CHECK(survey.reduction.pressure_channel.value().name() == "XX.BARO..LDI");
    CHECK(survey.reduction.pressure_channel->counts_per_hpa == 10.0);
    CHECK(survey.reduction.pressure_channel->archive == survey.root / "archive");
    CHECK(survey.occupations == desk.folder.path() / "o.csv");
    CHECK(survey.survey.base == "No.0");
    CHECK(survey.survey.datum == std::vector<std::string>{"No.0", "No.1"});
    CHECK(survey.survey.model == "t-rate");
    CHECK_FALSE(survey.survey.use_flags);
    CHECK(survey.tide.source == "longman");
    CHECK(survey.tide.factors.delta2 == 1.2);
    CHECK(survey.survey.seed == 9);
    CHECK(survey.averaging.trend == TrendMethod::smoother);
    CHECK(survey.averaging.cutoff_s == 240.0);
    CHECK(survey.averaging.norm == NormOrder::as_published);
}

TEST_CASE("a site is named in wide characters as well") {
    const Desk desk;
    const SurveyFile survey =
        desk.read("[survey]\nbase = \"\uFF2E\uFF4F.0\"\ndatum = [\"No.\uFF10\"]\n");
    CHECK(survey.survey.base == "No.0");
    CHECK(survey.survey.datum == std::vector<std::string>{"No.0"});
}

TEST_CASE("priors are read with mean and standard deviation") {
    const Desk desk;
    const adjustment::Priors priors =
        desk.read("[survey]\nreading_sd_mgal=1.5\n[prior]\nrate_mgal_per_degc_per_h=[10,6]\n")
            .survey.priors;
    REQUIRE(priors.find("rate_mgal_per_degc_per_h") != nullptr);
    CHECK(priors.find("rate_mgal_per_degc_per_h")->mean == 10.0);
    CHECK(priors.find("rate_mgal_per_degc_per_h")->sd == 6.0);
    CHECK(priors.find("time_mgal_per_h") == nullptr);
    CHECK(priors.reading_sd_mgal == 1.5);
}

TEST_CASE("the model paper uses the publication's trend and curve, whatever is configured") {
    const Desk desk;
    CHECK(averaging_of(desk.read("[survey]\nmodel='paper'\n")).curve == TrendCurve::paper);
    CHECK(averaging_of(desk.read("[survey]\nmodel='t'\n")).curve == TrendCurve::slow);
    CHECK(averaging_of(desk.read("[survey]\nmodel='paper'\ntrend='smoother'\n")).trend ==
          TrendMethod::eemd);
    CHECK(averaging_of(desk.read("[survey]\nmodel='t'\ntrend='smoother'\n")).trend ==
          TrendMethod::smoother);
}

TEST_CASE("the tide can be a file beside the survey file") {
    const Desk desk;
    desk.folder.write("tide.csv", "");
    const SurveyFile survey = desk.read("[survey]\ntide='tide.csv'\n");
    CHECK(survey.tide.source == "tide.csv");
    CHECK(survey.tide.series == desk.folder.path() / "tide.csv");
}

TEST_CASE("a bad survey file is refused with line, key and value") {
    const Desk desk;
    const auto [toml, message] = GENERATE(table<std::string, std::string>({
        {"[survey]\nbasis='No.0'\n", ":2: survey.basis = 'No.0': unknown key"},
        {"[surveys]\n", "unknown key"},
        {"[survey]\nbase='No.9'\n", "no such site; allowed: No.0, No.1"},
        {"[survey]\ndatum=['No.0','No.9']\n", "survey.datum"},
        {"[survey]\nmodel='kriging'\n",
         "allowed: auto, paper, day, t, t-rate, t-drift, t-rate-drift, "
         "t-rate-drift-axes, drift, network"},
        {"[survey]\ncurve='slow'\n", "the curve follows from the model"},
        {"[survey]\nrobust_terms='t'\n", "every model but paper is searched for bad readings"},
        {"[survey]\ntide='moon'\n", ":2: survey.tide = 'moon': neither a source nor a file"},
        {"[survey]\nroot='nowhere'\n", "no such directory"},
        {"[survey]\ncalibration='unit.toml'\n", "survey.calibration"},
        {"[survey]\ndelta2=116\n", "survey.delta2 = 116"},
        {"[survey]\ncutoff_s=10\n", "survey.cutoff_s = 10"},
        {"[survey]\npressure_channel='XX.BARO.00.LNO'\n", "not a channel of pressure"},
        {"[survey]\npressure_channel='XX.BARO.00.LDO'\npressure_counts_per_hpa=0\n",
         "survey.pressure_counts_per_hpa = 0"},
        {"[survey]\npressure='p.csv'\npressure_channel='XX.BARO.00.LDO'\n", "one of them"},
        {"[survey]\ntrend='spline'\n", "allowed: eemd, smoother"},
        {"[survey]\nseed=-1\n", "survey.seed = -1"},
        {"[survey]\nname=''\n", "survey.name"},
        {"[survey]\nreading_sd_mgal=0\n", "survey.reading_sd_mgal = 0"},
        {"[survey]\n[prior]\nbeta=[1,2]\n",
         ":3: prior.beta = [ 1, 2 ]: unknown key; allowed: rate_mgal_per_degc_per_h, scale, "},
        {"[survey]\n[prior]\ntime_mgal_per_h=[0]\n", "1 numbers; allowed: [mean, sd]"},
        {"[survey]\n[prior]\ntime_mgal_per_h=[0,0]\n", "out of range; allowed: mean from -"},
        {"[survey]\n[prior]\ntime_mgal_per_h=1\n", "prior.time_mgal_per_h = 1: wrong type"},
        {"[survey]\nsites='none.csv'\n", "none.csv: cannot be read"},
    }));
    CAPTURE(toml);
    CHECK_THROWS_WITH(desk.read(toml), ContainsSubstring(message));
    CHECK_THROWS_AS(desk.read(toml), InputError);
}
