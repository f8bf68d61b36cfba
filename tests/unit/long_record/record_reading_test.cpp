#include <fmt/core.h>
#include <sys/stat.h>

#include <cmath>
#include <string>
#include "tests/support/catch.hpp"

#include "corrector/long_record/csv_record.hpp"
#include "corrector/long_record/stretch_builder.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::long_record;
using namespace a351::corrector;

namespace {

const UtcTime kReadingStart = *parse_rfc3339("2026-03-01T00:00:00Z");
const archive_series::Progress kSilent = [](std::size_t, std::size_t) {};

std::string rows(double step_s, int first, int end) {
    std::string text;
    for (int i = first; i < end; ++i)
        text += to_rfc3339(kReadingStart + from_seconds(step_s * i), 3) + "," +
                std::to_string(979763.0 + i % 7) + ",42.5\n";
    return text;
}

/// Returns rows with `time_s`, without a header.
std::string seconds(double step_s, double first_s, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += std::to_string(first_s + step_s * i) + ",979763,42.5\n";
    return text;
}

const std::string kHeader = "time_utc,acceleration_mgal,temperature_degc\n";

}  // namespace

TEST_CASE("the stretch does not depend on the size of the blocks in which samples arrive") {
    const auto build = [](std::size_t block) {
        StretchBuilder builder(2, 3);
        builder.set_time(0, kReadingStart);
        for (std::size_t at = 0; at < 5000; at += block) {
            std::vector<std::vector<double>> channels(4);
            for (std::size_t i = at; i < std::min<std::size_t>(5000, at + block); ++i) {
                const auto x = static_cast<double>(i);
                channels[0].push_back(std::sin(x));
                channels[1].push_back(std::cos(x));
                channels[2].push_back(979763.0);
                channels[3].push_back(42.5 + 0.01 * std::sin(0.001 * x));
            }
            builder.push(channels);
        }
        return builder.finish(2.0);
    };
    const RecordStretch whole = build(5000), cut = build(77);
    REQUIRE(whole.size() == 50);
    REQUIRE(cut.size() == 50);
    REQUIRE(whole.axes_mgal.size() == 3);
    CHECK(whole.axes_mgal[2][25] == Approx(979763.0).epsilon(0.0).margin(1e-6));
    CHECK(whole.times[3] == kReadingStart + from_seconds(6.0));
    for (std::size_t k = 0; k < 50; ++k) {
        CHECK(std::isnan(whole.quantity[k]) == (k < 5 || k > 45));
        if (k < 5 || k > 45) continue;
        CHECK(whole.quantity[k] == cut.quantity[k]);
        CHECK(whole.temperature_degc[k] == cut.temperature_degc[k]);
        // The axes are decimated first, so that vibration of 1 mGal across the vertical has no
        // effect.
        CHECK(whole.quantity[k] == Approx(979763.0).epsilon(0.0).margin(1e-6));
        CHECK(whole.raw[k].acceleration_high_mgal == cut.raw[k].acceleration_high_mgal);
        CHECK(whole.raw[k].temperature_low_degc <= whole.temperature_degc[k]);
    }
}

TEST_CASE("a CSV at 2 s is decimated once, and missing rows are a gap") {
    const test::TemporaryDirectory folder;
    const auto file = folder.write("r.csv", kHeader + rows(2.0, 0, 1000) + rows(2.0, 1030, 3000));
    const LongRecord record = read_csv_record(file, {}, kSilent);
    REQUIRE(record.stretches.size() == 1);
    const RecordStretch& stretch = record.stretches[0];
    REQUIRE(stretch.size() == 300);
    CHECK(stretch.times[200] == kReadingStart + from_seconds(4000.0));
    CHECK(std::isnan(stretch.quantity[100]));
    CHECK(std::isfinite(stretch.quantity[95]));
    CHECK(std::isfinite(stretch.quantity[108]));
    CHECK(stretch.quantity[50] == Approx(979766.0).epsilon(0.0).margin(0.1));
}

TEST_CASE("a CSV at 20 s is taken as it is, and a long gap begins a new stretch") {
    const test::TemporaryDirectory folder;
    const auto file = folder.write("r.csv", kHeader + rows(20.0, 0, 50) + rows(20.0, 300, 350));
    const LongRecord record = read_csv_record(file, {}, kSilent);
    REQUIRE(record.stretches.size() == 2);
    CHECK(record.stretches[0].quantity[13] == 979769.0);
    CHECK(record.stretches[0].raw.empty());
    RecordWindow window;
    window.from = kReadingStart + from_seconds(200.0);
    window.to = kReadingStart + from_seconds(400.0);
    CHECK(read_csv_record(file, window, kSilent).stretches[0].size() == 10);
}

TEST_CASE("rows missing here and there are not taken for another step") {
    const test::TemporaryDirectory folder;
    std::string text = kHeader;
    for (int i = 0; i < 500; ++i)
        if (i < 300 || i % 3 == 0) text += rows(20.0, i, i + 1);
    const LongRecord record = read_csv_record(folder.write("r.csv", text), {}, kSilent);
    REQUIRE(record.stretches.size() == 1);
    CHECK(record.stretches[0].size() == 499);
}

TEST_CASE("the acceleration of a CSV may count from any zero") {
    const test::TemporaryDirectory folder;
    std::string text = "time_s,acceleration_mgal,temperature_degc\n";
    for (int i = 0; i < 50; ++i)
        text += std::to_string(20 * i) + "," + std::to_string(9.7 + 0.1 * (i % 3)) + ",42.5\n";
    CHECK(read_csv_record(folder.write("r.csv", text), {}, kSilent).stretches[0].size() == 50);
}

TEST_CASE("a file that cannot be a record is refused with its line") {
    const test::TemporaryDirectory folder;
    const auto refused = [&](const std::string& text, const std::string& message) {
        const auto file = folder.write("r.csv", text);
        CHECK_THROWS_WITH(read_csv_record(file, {}, kSilent), ContainsSubstring(message));
    };
    refused(kHeader + rows(3.0, 0, 50), "a row every 3 s; allowed: every 0.02, 0.2, 2 or 20 s");
    refused(kHeader + rows(20.0, 0, 5) + rows(20.0, 2, 9), "r.csv:7: time_utc");
    refused(kHeader + rows(20.0, 0, 5) + "2026-03-01T01:00:00Z,abc,42\n",
            "r.csv:7: acceleration_mgal");
    refused("time_utc,temperature_degc\n2026-03-01T01:00:00Z,42\n", "acceleration_mgal");
    refused(kHeader + rows(20.0, 0, 1), "fewer than two rows");
    refused(
        "time_s,acceleration_mgal,temperature_degc\n" + seconds(20.0, 0.0, 2160) +
            seconds(10.0, 43200.0, 2160),
        "r.csv:2203: a row every 10 s from about here on, every 20 s elsewhere; allowed: one step");
    refused("time_s,acceleration_mgal,temperature_degc\n" + seconds(20.0, 0.0, 300) +
                seconds(10.0, 6000.0, 30),
            "a row every 10 s");
    const auto in_unit = [](double mgal) {  // 979763 mGal, with a swing of 6 mGal
        std::string text = "time_s,acceleration_mgal,temperature_degc\n";
        for (int i = 0; i < 50; ++i)
            text += fmt::format("{},{:.9f},42.5\n", 20 * i, (979760.0 + i % 7) / mgal);
        return text;
    };
    refused(in_unit(1e5), "the median is 9.79763, which is gravity in m/s2; allowed: mGal");
    refused(in_unit(1e3), "gravity in Gal");
    refused(in_unit(980665.0), "gravity in g");
    const auto fifo = folder.path() / "fifo";
    REQUIRE(::mkfifo(fifo.c_str(), S_IRUSR | S_IWUSR) == 0);
    CHECK_THROWS_WITH(read_csv_record(fifo, {}, kSilent),
                      ContainsSubstring("is not a regular file"));
}
