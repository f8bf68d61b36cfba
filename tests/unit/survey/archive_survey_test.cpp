// A made-up morning written as miniSEED, StationXML and occupations, and corrected from there.
#include <catch2/catch.hpp>
#include <cmath>
#include <span>

#include "corrector/survey/occupation_rows.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/record/channel_code.hpp"
#include "protocol/record/event_log.hpp"
#include "protocol/record/miniseed.hpp"
#include "protocol/record/sds.hpp"
#include "protocol/record/station_xml.hpp"
#include "tests/unit/survey/scratch_folder.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace std::chrono_literals;

namespace {

constexpr double kTrueRate_hz = 50.002;                                  // 40 ppm off
const UtcTime kMorning = parse_rfc3339("2020-05-01T23:50:00Z").value();  // over midnight
constexpr auto kStay = 150s;
constexpr auto kCycle = 240s;  // stay and way
const std::vector<std::string> kSites{"B", "S1", "S2", "B"};
const std::vector<double> kGravity_mgal{979800.0, 979850.0, 979760.0, 979800.0};
constexpr double kConstant_mgal = 1850.0;
constexpr double kSlope_mgal_per_degc = -30.0;
constexpr double kTilt_g = 0.01;

double temperature_degc(double seconds) { return 42.3 + 0.4 * std::sin(seconds / 900.0); }

/// What the sensor reads, in mGal, at its place of that instant, tide aside.
double reading_mgal(double seconds) {
    const auto cycle = static_cast<std::size_t>(seconds / 240.0);
    return kGravity_mgal[std::min(cycle, kSites.size() - 1)] + kConstant_mgal +
           kSlope_mgal_per_degc * (temperature_degc(seconds) - 42.6);
}

class Morning {
public:
    Morning() {
        record::StationDescription description;
        description.start = kMorning;
        description.profile = "A351";
        description.output_rate_hz = 50;
        description.filter = "k512_fc9";
        folder_.write("data/metadata/station.xml", record::to_station_xml(description));
        const auto station = record::read_station_xml(folder_.path() / "data/metadata/station.xml");
        for (const auto& channel : station.channels)
            if (!record::is_derived(channel.code)) write_channel(channel);
        folder_.write("sites.csv",
                      "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                      "B,140.1,36.2,500,979800\nS1,140.0,36.1,200,979850\n"
                      "S2,140.2,36.3,800,979760\n");
        std::string rows = "site,occupation,start_utc,end_utc,used,note\n";
        for (std::size_t i = 0; i < kSites.size(); ++i) {
            const UtcTime start = start_of(i);
            rows += kSites[i] + (i == 3 ? ",2," : ",1,") + to_rfc3339(start) + ',' +
                    to_rfc3339(start + kStay) + (i == 2 ? ",0,\n" : ",,\n");
        }
        folder_.write("occupations.csv", rows);
    }

    [[nodiscard]] static UtcTime start_of(std::size_t i) {
        return kMorning + static_cast<int>(i) * kCycle + 20s;
    }

    [[nodiscard]] OccupationRows average(
        const std::string& keys = "occupations='occupations.csv'\n") {
        const auto file = folder_.write("day.toml", "[survey]\ntide='none'\n" + keys);
        return average_occupations(read_survey_file(file), [](std::size_t, std::size_t) {});
    }

    [[nodiscard]] const ScratchFolder& folder() const { return folder_; }

private:
    void write_channel(const record::ChannelScale& channel) {
        std::vector<std::int32_t> counts;
        const auto total =
            static_cast<std::size_t>(static_cast<double>(kSites.size()) * 240.0 * kTrueRate_hz);
        const double g_mgal = kMilliGalPerStandardGravity;
        for (std::size_t i = 0; i < total; ++i) {
            const double seconds = static_cast<double>(i) / kTrueRate_hz;
            double value = temperature_degc(seconds);
            if (channel.code == "BN1") value = kTilt_g * g_mgal * 1e-5;
            if (channel.code == "BN2") value = 0.0;
            if (channel.code == "BNZ") {
                const double reading = reading_mgal(seconds);
                value = std::sqrt(reading * reading - kTilt_g * kTilt_g * g_mgal * g_mgal) * 1e-5;
            }
            counts.push_back(
                static_cast<std::int32_t>(std::llround((value - channel.offset) / channel.gain)));
        }
        record::SdsWriter writer(record::posix_files(), folder_.path() / "data/archive", {});
        std::size_t at = 0;
        while (at < counts.size()) {
            record::RecordHeader header;
            header.network = "XX";
            header.station = "A351";
            header.location = "00";
            header.channel = channel.code;
            header.start = kMorning + from_seconds(static_cast<double>(at) / kTrueRate_hz);
            header.nominal_rate = Hertz(50.0);
            const std::size_t before_midnight = samples_before_midnight(at, counts.size());
            const auto packed =
                record::pack_record(header, std::span(counts).subspan(at, before_midnight));
            writer.append(channel.code, packed);
            at += packed.sample_count;
        }
        writer.sync();
    }

    /// No record crosses midnight, 600 s after kMorning.
    static std::size_t samples_before_midnight(std::size_t at, std::size_t count) {
        const auto first_after = static_cast<std::size_t>(std::ceil(600.0 * kTrueRate_hz));
        return at < first_after ? std::min(first_after, count) - at : count - at;
    }

    ScratchFolder folder_;
};

}  // namespace

TEST_CASE("occupations come out of the archive at the values that were put in",
          "[survey][archive]") {
    Morning morning;
    const OccupationRows result = morning.average();
    CHECK(result.warnings.empty());
    REQUIRE(result.rows.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CAPTURE(i);
        const SurveyRow& row = result.rows[i];
        CHECK(row.site == kSites[i]);
        CHECK(row.occupation == (i == 3 ? 2 : 1));
        CHECK(row.is_flagged == (i == 2));
        CHECK(row.reference == MilliGal(kGravity_mgal[i]));
        CHECK(row.start.value() >= Morning::start_of(i));
        CHECK(row.end.value() <= Morning::start_of(i) + kStay);
        // The middle of the interval stands for its mean to the curvature of the temperature,
        // 0.4 degC (75 s / 900 s)^2 / 6; the trend's ends and the quantisation make the rest.
        const double middle = seconds_between(kMorning, row.time);
        CHECK(row.temperature.value() == Approx(temperature_degc(middle)).epsilon(0).margin(0.001));
        CHECK(row.acceleration.value() == Approx(reading_mgal(middle)).epsilon(0).margin(0.03));
        const double rate = 0.4 / 900.0 * std::cos(middle / 900.0) * 3600.0;
        CHECK(row.rate_degc_per_h == Approx(rate).epsilon(0).margin(0.01));
    }
}

TEST_CASE("two runs over the same archive give the same bits", "[survey][archive]") {
    Morning morning;
    const auto a = morning.average();
    const auto b = morning.average();
    REQUIRE(a.rows.size() == b.rows.size());
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        CHECK(a.rows[i].acceleration == b.rows[i].acceleration);
        CHECK(a.rows[i].temperature == b.rows[i].temperature);
    }
    REQUIRE(a.inputs.size() == b.inputs.size());
    CHECK(a.inputs.size() == 4 + 8);  // survey, sites, metadata, occupations; 4 channels, 2 days
}

TEST_CASE("occupations are taken from the event log where no table is named", "[survey][archive]") {
    Morning morning;
    for (std::size_t i = 0; i < kSites.size(); ++i) {
        record::Event start{"start", Morning::start_of(i), {}, {}, {{"site", kSites[i]}}};
        record::Event stop{"stop", Morning::start_of(i) + kStay, {}, {}, {}};
        record::append_event(record::posix_files(), morning.folder().path() / "data/events", start);
        record::append_event(record::posix_files(), morning.folder().path() / "data/events", stop);
    }
    const auto logged = morning.average("");
    const auto listed = morning.average();
    REQUIRE(logged.rows.size() == listed.rows.size());
    for (std::size_t i = 0; i < logged.rows.size(); ++i) {
        CHECK(logged.rows[i].acceleration == listed.rows[i].acceleration);
        CHECK(logged.rows[i].occupation == listed.rows[i].occupation);
    }
}

TEST_CASE("an occupation outside the archive is left out and named", "[survey][archive]") {
    Morning morning;
    morning.folder().write("late.csv",
                           "site,occupation,start_utc,end_utc,used,note\n"
                           "B,1,2020-05-01T23:50:20Z,2020-05-01T23:52:50Z,1,\n"
                           "S1,1,2020-05-02T03:00:00Z,2020-05-02T03:10:00Z,1,\n");
    const auto result = morning.average("occupations='late.csv'\n");
    CHECK(result.rows.size() == 1);
    REQUIRE(result.warnings.size() == 1);
    CHECK(result.warnings[0] == "S1 (1) at 2020-05-02T03:00:00Z is left out: no samples");
}

TEST_CASE("a survey without any sample is refused", "[survey][archive]") {
    Morning morning;
    morning.folder().write("other.csv",
                           "site,occupation,start_utc,end_utc,used,note\n"
                           "B,1,2021-05-01T23:50:20Z,2021-05-01T23:52:50Z,1,\n");
    CHECK_THROWS_AS(morning.average("occupations='other.csv'\n"), InputError);
}

TEST_CASE("the tide is that of the middle of the interval", "[survey][archive]") {
    Morning morning;
    const auto file = morning.folder().write(
        "day.toml", "[survey]\noccupations='occupations.csv'\ndelta2=1.2\ndelta3=1.2\n");
    const auto result =
        average_occupations(read_survey_file(file), [](std::size_t, std::size_t) {});
    for (const SurveyRow& row : result.rows) {
        const UtcTime middle = *row.start + (*row.end - *row.start) / 2;
        const auto sites = text::read_sites(morning.folder().path() / "sites.csv");
        const auto* site = text::find_site(sites, row.site);
        CHECK(row.tide ==
              direct_tide(middle, {site->latitude, site->longitude, site->altitude}, {1.2, 1.2}));
    }
}
