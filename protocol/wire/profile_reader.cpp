#include "protocol/wire/profile_reader.hpp"

#include <algorithm>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::wire {
namespace {

using text::TomlTable;

constexpr std::size_t kProductIdLength = 8;  ///< Characters of PROD_ID1 to PROD_ID4.
constexpr int kLargestCode = 15;             ///< The widest fields of registers have four bits.
constexpr int kLargestBaudCode = 3;
constexpr int kMostUserTaps = 512;  ///< Coefficients for which the device has memory.
/// Rates for which the programs are tested.  The live view lowers each to 5 Hz.
constexpr int kLowestRate_hz = 50, kHighestRate_hz = 1000, kRateUnit_hz = 5;

void require(const TomlTable& table, std::string_view key, std::string_view allowed) {
    if (!table.has(key)) table.refuse(key, "missing", allowed);
}

int required_integer(TomlTable& table, std::string_view key, int low, int high) {
    require(table, key,
            "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return static_cast<int>(table.integer_or(key, 0, low, high));
}

bool required_boolean(TomlTable& table, std::string_view key) {
    require(table, key, "true or false");
    return table.boolean_or(key, false);
}

bool is_letter_or_digit(char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/// Reads a text of letters and digits.
std::string required_word(TomlTable& table, std::string_view key, std::string_view also,
                          std::size_t shortest, std::size_t longest) {
    const std::string allowed = std::to_string(shortest) + " to " + std::to_string(longest) +
                                " letters, digits" + (also.empty() ? "" : " or ") +
                                std::string(also);
    require(table, key, allowed);
    std::string word = table.string_or(key, "");
    const bool is_word = std::ranges::all_of(word, [also](char c) {
        return is_letter_or_digit(c) || also.find(c) != std::string_view::npos;
    });
    if (!is_word || word.size() < shortest || word.size() > longest)
        table.refuse(key, "not a name", allowed);
    return word;
}

/// Checks the key `source`, which is for people who read the file.
void require_source(TomlTable& table) {
    constexpr std::string_view kAllowed = "where the values are from, or \"assumed: ...\"";
    require(table, "source", kAllowed);
    if (table.string_or("source", "").empty()) table.refuse("source", "empty", kAllowed);
}

/// Reads a table that must be there, and its source.
TomlTable required_table(TomlTable& document, std::string_view name) {
    require(document, name, "the table [" + std::string(name) + "]");
    TomlTable table = document.table(name);
    require_source(table);
    return table;
}

std::vector<TomlTable> required_choices(TomlTable& table) {
    constexpr std::string_view kAllowed = "an array of at least one table";
    require(table, "choices", kAllowed);
    std::vector<TomlTable> choices = table.tables("choices");
    if (choices.empty()) table.refuse("choices", "empty", kAllowed);
    table.require_all_read();
    return choices;
}

void read_scales(TomlTable& document, DeviceProfile& profile) {
    TomlTable acceleration = required_table(document, "acceleration");
    profile.acceleration_fraction_bits = required_integer(acceleration, "fraction_bits", 8, 30);
    profile.rated_range =
        StandardGravity(acceleration.required_number("rated_range_g", 1.0, 1000.0));
    acceleration.require_all_read();

    TomlTable tilt = required_table(document, "tilt");
    profile.tilt_fraction_bits = required_integer(tilt, "fraction_bits", 8, 30);
    tilt.require_all_read();

    TomlTable temperature = required_table(document, "temperature");
    profile.temperature_slope_degc = temperature.required_number("slope_degc", -1.0, 1.0);
    if (profile.temperature_slope_degc == 0.0)
        temperature.refuse("slope_degc", "has no inverse", "a number from -1 to 1, but not 0");
    profile.temperature_offset_degc = temperature.required_number("offset_degc", -1e6, 1e6);
    profile.temperature_bits = required_integer(temperature, "width_bits", 16, 32);
    if (profile.temperature_bits != 16 && profile.temperature_bits != 32)
        temperature.refuse("width_bits", "not a width of the device", "16, 32");
    temperature.require_all_read();
}

void read_noise(TomlTable& document, DeviceProfile& profile) {
    if (!document.has("noise")) return;
    TomlTable noise = required_table(document, "noise");
    profile.noise_ug_per_sqrt_hz = noise.required_number("ug_per_sqrt_hz", 1e-4, 1e4);
    noise.require_all_read();
}

void read_times(TomlTable& document, DeviceProfile& profile) {
    TomlTable timing = required_table(document, "timing");
    profile.internal_rate_hz = required_integer(timing, "tick_hz", 1, 1'000'000);
    profile.data_ready_delay =
        std::chrono::microseconds(required_integer(timing, "data_ready_us", 0, 1'000'000));
    profile.start_up =
        std::chrono::milliseconds(required_integer(timing, "start_up_ms", 100, 2500));
    timing.require_all_read();
}

/// Adds a value with its code; neither may be there already.
void add_coded(const TomlTable& table, std::string_view key, Coded coded,
               std::vector<Coded>& known) {
    for (const Coded& other : known) {
        if (other.value == coded.value) table.refuse(key, "given twice", "each value once");
        if (other.code == coded.code) table.refuse("code", "given twice", "each code once");
    }
    known.push_back(coded);
}

void read_rates(TomlTable& document, DeviceProfile& profile) {
    TomlTable rates = required_table(document, "output_rate");
    for (TomlTable& choice : required_choices(rates)) {
        const int hz = required_integer(choice, "hz", kLowestRate_hz, kHighestRate_hz);
        const int code = required_integer(choice, "code", 0, kLargestCode);
        const int tick_hz = profile.internal_rate_hz;
        if (tick_hz % hz != 0 || hz % kRateUnit_hz != 0) {
            choice.refuse(
                "hz", "not a whole number of ticks per sample, or no multiple of 5",
                "a divisor of timing.tick_hz = " + std::to_string(tick_hz) + " and multiple of 5");
        }
        choice.require_all_read();
        add_coded(choice, "hz", {hz, static_cast<std::uint8_t>(code)}, profile.output_rates_hz);
    }
    TomlTable bauds = required_table(document, "baud");
    for (TomlTable& choice : required_choices(bauds)) {
        const int baud = required_integer(choice, "baud", 9600, 4'000'000);
        const int code = required_integer(choice, "code", 0, kLargestBaudCode);
        choice.require_all_read();
        add_coded(choice, "baud", {baud, static_cast<std::uint8_t>(code)}, profile.baud_rates);
    }
}

std::string rate_list(const DeviceProfile& profile) {
    std::vector<std::string> rates;
    for (const Coded& rate : profile.output_rates_hz) rates.push_back(std::to_string(rate.value));
    return text::joined(rates);
}

FilterSpec read_filter(TomlTable& choice, const DeviceProfile& profile) {
    FilterSpec filter;
    filter.name = required_word(choice, "name", "_", 1, 24);
    filter.code = static_cast<std::uint8_t>(required_integer(choice, "code", 0, kLargestCode));
    filter.is_user = choice.boolean_or("user", false);
    filter.taps = required_integer(choice, "taps", 1, filter.is_user ? kMostUserTaps : 65'536);
    require(choice, "rates_hz", "some of " + rate_list(profile));
    for (const double rate : choice.numbers("rates_hz", 1, 100'000)) {
        const auto rate_hz = static_cast<int>(rate);
        if (rate_hz != rate || !profile.has_output_rate(rate_hz))
            choice.refuse("rates_hz", "not an output rate of the profile", rate_list(profile));
        filter.allowed_rates_hz.push_back(rate_hz);
    }
    if (filter.allowed_rates_hz.empty())
        choice.refuse("rates_hz", "empty", "some of " + rate_list(profile));
    choice.require_all_read();
    return filter;
}

void read_filters(TomlTable& document, DeviceProfile& profile) {
    TomlTable table = required_table(document, "filter");
    for (TomlTable& choice : required_choices(table)) {
        FilterSpec filter = read_filter(choice, profile);
        if (profile.filter_named(filter.name) != nullptr)
            choice.refuse("name", "given twice", "each name once");
        if (profile.filter_coded(filter.code) != nullptr)
            choice.refuse("code", "given twice", "each code once");
        profile.filters.push_back(std::move(filter));
    }
    for (const Coded& rate : profile.output_rates_hz) {
        if (profile.filters_allowed_at(rate.value).empty()) {
            document.refuse("filter",
                            "no filter for the output rate " + std::to_string(rate.value) + " Hz",
                            "at least one that is not a user's for each of output_rate.choices");
        }
    }
}

}  // namespace

DeviceProfile parse_profile(std::string_view toml, std::string name,
                            const std::filesystem::path& origin) {
    TomlTable document = text::parse_toml(toml, origin);
    DeviceProfile profile;
    profile.name = std::move(name);
    profile.product_id_prefix = required_word(document, "prefix", "", 1, kProductIdLength);
    profile.product_id =
        required_word(document, "product_id", "", kProductIdLength, kProductIdLength);
    if (!profile.product_id.starts_with(profile.product_id_prefix))
        document.refuse("product_id", "does not begin with prefix",
                        profile.product_id_prefix + " and further letters or digits");
    profile.is_verified = required_boolean(document, "verified");
    require_source(document);
    read_scales(document, profile);
    read_noise(document, profile);
    read_times(document, profile);
    read_rates(document, profile);
    read_filters(document, profile);
    document.require_all_read();
    return profile;
}

}  // namespace a351::wire
