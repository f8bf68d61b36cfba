#include "daemon/identify/identify_file.hpp"

#include <filesystem>
#include <sstream>

#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/identify/made_up_sensor.hpp"

namespace a351::daemon::identify {

TEST_CASE("the file to be sent has the report, each register and each byte with its arrival") {
    Observation seen = MadeUpSensor{}.observe();
    seen.registers[1].value.reset();
    const Report report = report_on(seen, expected_a351());
    const std::string text = file_text(seen, report);
    CHECK(text.find(to_text(report)) != std::string::npos);
    CHECK(text.find("\nW0:00 BURST 0xFFFF\nW0:02 MODE_CTRL no answer\n") != std::string::npos);
    CHECK(text.find("\nW1:6A PROD_ID1 0x3341\n") != std::string::npos);

    std::istringstream lines(text.substr(text.find("[bytes]\n") + 8));
    std::vector<std::byte> bytes;
    double after_s = 0.0;
    for (std::string hex; lines >> after_s >> hex;)
        for (std::size_t i = 0; i < hex.size(); i += 2)
            bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    CHECK((bytes == seen.bytes));
    CHECK(after_s == Approx(2499 / 50.0));
}

TEST_CASE("the name of the files has no character that a name of a profile must not have") {
    Observation seen = MadeUpSensor{}.observe();
    CHECK(file_stem(seen) == "identify-00000042-20260301T120000Z");
    seen.device.serial_number = std::string("../1\0\n\"8", 8);
    CHECK(file_stem(seen) == "identify-___1___8-20260301T120000Z");
    seen.device.serial_number.clear();
    CHECK(file_stem(seen) == "identify-unknown-20260301T120000Z");
}

TEST_CASE("a profile that was made is written beside the file") {
    const test::TemporaryDirectory folder;
    const Observation seen = MadeUpSensor{}.observe();
    Report report = report_on(seen, expected_a351());
    for (const bool has_profile : {false, true}) {
        report.toml = has_profile ? std::optional<std::string>("name = \"x\"\n") : std::nullopt;
        const auto stem = folder.path() / write_files(folder.path(), seen, report);
        CHECK(std::filesystem::exists(stem.string() + ".txt"));
        CHECK(std::filesystem::exists(stem.string() + ".toml") == has_profile);
    }
}

}  // namespace a351::daemon::identify
