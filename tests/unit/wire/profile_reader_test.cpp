#include "protocol/wire/profile_reader.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/wire/shipped_profiles.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

namespace a351::wire {
namespace {

std::string shipped(std::string_view name) {
    for (const ShippedProfile& file : shipped_profiles())
        if (file.name == name) return std::string(file.toml);
    return {};
}

/// Returns the file of the A352AD10 with one passage replaced, which must be there once.
std::string changed(std::string_view from, std::string_view to) {
    std::string text = shipped("A352AD10");
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    REQUIRE(text.find(from, at + 1) == std::string::npos);
    return text.replace(at, from.size(), to);
}

std::string refusal_of(const std::string& toml) {
    try {
        static_cast<void>(parse_profile(toml, "mine", "mine.toml"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string refusal(std::string_view from, std::string_view to) {
    return refusal_of(changed(from, to));
}

}  // namespace

TEST_CASE("a profile file with a mistake is refused with key, value and what is allowed") {
    CHECK(
        refusal("slope_degc = -0.0037918", "slope_degc = 0") ==
        "mine.toml:17: temperature.slope_degc = 0: has no inverse; allowed: a number from -1 to 1, "
        "but not 0");
    CHECK(refusal("offset_degc = 34.987", "ofset_degc = 34.987") ==
          "mine.toml:18: temperature.ofset_degc: unknown key; did you mean offset_degc?");
    CHECK(refusal("offset_degc = 34.987", "") ==
          "mine.toml:16: temperature.offset_degc: missing; allowed: a number");
    CHECK(refusal("offset_degc = 34.987", "offset_degc = 34.987\ncolour = 1") ==
          "mine.toml:19: temperature.colour = 1: unknown key; allowed: offset_degc, slope_degc, "
          "source, width_bits");
    CHECK(refusal("width_bits = 32", "width_bits = 24") ==
          "mine.toml:19: temperature.width_bits = 24: not a width of the device; allowed: 16, 32");
    CHECK(
        refusal("hz = 1000, code = 2", "hz = 600, code = 2") ==
        "mine.toml:30: output_rate.choices.hz = 600: not a whole number of ticks per sample, or no "
        "multiple of 5; allowed: a divisor of timing.tick_hz = 4000 and multiple of 5");
    CHECK(
        refusal("hz = 50, code = 6", "hz = 40, code = 6") ==
        "mine.toml:34: output_rate.choices.hz = 40: out of range; allowed: a whole number from 50 "
        "to 1000");
    CHECK(refusal("hz = 500, code = 3", "hz = 500, code = 2") ==
          "mine.toml:31: output_rate.choices.code = 2: given twice; allowed: each code once");
    CHECK(refusal("hz = 500, code = 3", "hz = 1000, code = 3") ==
          "mine.toml:31: output_rate.choices.hz = 1000: given twice; allowed: each value once");
    CHECK(refusal("baud = 230400, code = 2", "baud = 230400, code = 4") ==
          "mine.toml:41: baud.choices.code = 4: out of range; allowed: a whole number from 0 to 3");
    CHECK(refusal("ug_per_sqrt_hz = 0.2", "ug_per_sqrt_hz = 0")
              .find("noise.ug_per_sqrt_hz = 0: out of range; allowed: ") != std::string::npos);
    CHECK(refusal("verified = true", "verified = 1") ==
          "mine.toml:4: verified = 1: wrong type; allowed: true or false");
    CHECK(refusal("[tilt] ", "[tilting] ")
              .starts_with("mine.toml:1: tilt: missing; allowed: the table [tilt]"));
    CHECK(
        refusal("rated_range_g = 15.0", "rated_range_g = nan")
            .starts_with("mine.toml:9: acceleration.rated_range_g = nan: out of range; allowed: "));
    CHECK(refusal("source = \"M-A352AD10 data sheet, rev. 20251023, 7.6\"", "source = \"\"")
              .starts_with(
                  "mine.toml:20: temperature.source = '': empty; allowed: where the values"));
    CHECK(refusal("choices = [\n    { hz", "choices = []\nother = [\n    { hz")
              .starts_with("mine.toml:29: output_rate.choices"));
}

TEST_CASE("a profile file whose filters do not fit its rates is refused") {
    CHECK(refusal("code = 2, taps = 64, rates_hz = [1000]",
                  "code = 2, taps = 64, rates_hz = [900]") ==
          "mine.toml:49: filter.choices.rates_hz = [ 900 ]: not an output rate of the profile; "
          "allowed: 1000, 500, 200, 100, 50");
    CHECK(refusal("code = 2, taps = 64", "code = 1, taps = 64") ==
          "mine.toml:49: filter.choices.code = 1: given twice; allowed: each code once");
    CHECK(refusal("k64_fc220", "k64_fc83") ==
          "mine.toml:49: filter.choices.name = 'k64_fc83': given twice; allowed: each name once");
    CHECK(refusal("code = 2, taps = 64, rates_hz = [1000]",
                  "code = 2, taps = 0, rates_hz = [1000]") ==
          "mine.toml:49: filter.choices.taps = 0: out of range; allowed: a whole number from 1 to "
          "65536");
    CHECK(
        refusal("taps = 512, rates_hz = [50, 100, 200, 500, 1000] }",
                "taps = 512, rates_hz = [100, 200, 500, 1000] }") ==
        "mine.toml:46: filter: no filter for the output rate 50 Hz; allowed: at least one that is "
        "not a user's for each of output_rate.choices");
}

TEST_CASE("a product identifier that cannot be the device's is refused") {
    CHECK(refusal("prefix = \"A352AD10\"", "prefix = \"A352 AD1\"") ==
          "mine.toml:2: prefix = 'A352 AD1': not a name; allowed: 1 to 8 letters, digits");
    CHECK(refusal("product_id = \"A352AD10\"", "product_id = \"A370AD10\"") ==
          "mine.toml:3: product_id = 'A370AD10': does not begin with prefix; allowed: A352AD10 and "
          "further letters or digits");
    CHECK(refusal("product_id = \"A352AD10\"", "product_id = \"A352\"")
              .starts_with("mine.toml:3: product_id = 'A352': not a name; allowed: 8 to 8"));
}

TEST_CASE("a profile from a file is found by a name with a digest, and in a journal's header") {
    const test::TemporaryDirectory directory;
    const std::string text = changed("slope_degc = -0.0037918", "slope_degc = -5.78583e-8");
    const DeviceProfile& read = load_profile(directory.write("mine.toml", text));
    CHECK(read.name.starts_with("mine#"));
    CHECK(read.toml == text);
    CHECK(read.temperature_slope_degc == -5.78583e-8);
    CHECK(find_profile(read.name) == &read);

    // Another content, another profile; a copy of a shipped file is that profile.
    const DeviceProfile& other = load_profile(directory.write("mine.toml", text + "# once more\n"));
    CHECK(other.name != read.name);
    CHECK(&load_profile(directory.write("copy.toml", shipped("A351"))) == find_profile("A351"));

    CHECK(add_recorded_profile(read.name, text));
    CHECK_FALSE(add_recorded_profile(read.name, text + " "));
    CHECK_FALSE(add_recorded_profile("A351", text));
    CHECK_THROWS_AS(load_profile(directory.path() / "absent.toml"), InputError);
    CHECK_THROWS_AS(load_profile(directory.write("my profile.toml", text)), InputError);
}

}  // namespace a351::wire
