#include "protocol/text/sites.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/plain_text.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {
namespace {

/// Reads a column of coordinates.  Its empty cells become the mean of the others, which does not
/// depend on the order of the rows.
/// @param turn  period of the coordinate: 360 for longitudes.
std::vector<double> filled_column(const CsvTable& table, std::string_view column, double low,
                                  double high, double turn, std::vector<bool>& is_given,
                                  const std::filesystem::path& file) {
    std::vector<double> given;
    std::vector<double> values(table.row_count());
    for (std::size_t row = 0; row < values.size(); ++row) {
        const auto value = table.number_if_given(row, column, low, high);
        if (value) given.push_back(*value);
        if (!value) is_given[row] = false;
        values[row] = value.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    if (given.empty() && !values.empty()) {
        throw InputError(
            fmt::format("{}: {} = : empty for every site; allowed: a number for at least one",
                        file.string(), column));
    }
    std::ranges::sort(given);
    for (double& value : values) {
        if (!std::isnan(value)) continue;
        const double sum =
            std::accumulate(given.begin(), given.end(), 0.0, [&](double total, double one) {
                return total + std::remainder(one - given.front(), turn);
            });
        value = given.front() + sum / static_cast<double>(given.size());
    }
    return values;
}

struct Trouble {
    std::string_view trouble, allowed;
};

/// Returns what is wrong with the characters of a name; an empty text if nothing is.
Trouble trouble_with_characters(std::string_view name) {
    if (std::string_view("=+-@").find(name.front()) != std::string_view::npos)
        return {"begins with =, +, - or @, which a spreadsheet takes as a formula",
                "a letter or digit first"};
    if (has_hidden_character(name))
        return {"has a hidden character", "visible characters, and usual blanks between them"};
    if (name.find(',') != std::string_view::npos)
        return {"has a comma, which separates the columns of the results", "no comma"};
    if (name.find('"') != std::string_view::npos)
        return {"has a quotation mark, which programs read differently", "no \""};
    return {};
}

/// Returns a name in lower case without blanks and punctuation.
std::string bare(std::string_view name) {
    std::string text;
    for (const char c : name) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        const bool is_ascii = static_cast<unsigned char>(c) < 0x80;  // char can be unsigned
        if (!is_ascii || is_letter || (c >= '0' && c <= '9'))
            text += is_letter ? static_cast<char>(c | 0x20) : c;
    }
    return text;
}

}  // namespace

std::vector<Site> read_sites(const std::filesystem::path& file) {
    return parse_sites(read_text_file(file), file);
}

std::vector<Site> parse_sites(std::string_view text, const std::filesystem::path& origin) {
    constexpr double kNoTurn = 1e9;
    const CsvTable table = CsvTable::parse(text, origin);
    std::vector<bool> is_placed(table.row_count(), true), has_altitude = is_placed;
    const auto column = [&](std::string_view name, double low, double high, double turn,
                            std::vector<bool>& is_given) {
        return filled_column(table, name, low, high, turn, is_given, origin);
    };
    const auto longitudes = column("longitude_deg", -180.0, 360.0, 360.0, is_placed);
    const auto latitudes = column("latitude_deg", -90.0, 90.0, kNoTurn, is_placed);
    const auto altitudes =
        column("altitude_m", kLeastAltitude_m, kGreatestAltitude_m, kNoTurn, has_altitude);
    std::vector<Site> sites;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const std::string& name = table.cell(row, "site");
        if (name.empty()) table.refuse(row, "site", "empty", "a name");
        if (!is_utf8(name))
            table.refuse(row, "site", "not UTF-8", "UTF-8; in a spreadsheet: save as CSV UTF-8");
        if (const auto [trouble, allowed] = trouble_with_characters(name); !trouble.empty())
            table.refuse(row, "site", trouble, allowed);
        if (find_site(sites, name) != nullptr)
            table.refuse(row, "site", "appears twice", "each site once");
        Site site{name,
                  Degrees(longitudes[row]),
                  Degrees(latitudes[row]),
                  Metres(altitudes[row]),
                  std::nullopt,
                  is_placed[row]};
        if (!table.cell(row, "gravity_mgal").empty())
            site.gravity = MilliGal(table.unrounded(row, "gravity_mgal", kMostOfLastDigit_mgal,
                                                    kLeastGravity_mgal, kGreatestGravity_mgal));
        constexpr double kLeastReliable_mgal = 100.0;  // worse than any map of gravity anomalies
        if (const auto u =
                table.has_column("u_gravity_mgal")
                    ? table.number_if_given(row, "u_gravity_mgal", 0.0, kLeastReliable_mgal)
                    : std::nullopt)
            site.u_gravity = MilliGal(*u);
        site.has_altitude = has_altitude[row];
        sites.push_back(std::move(site));
    }
    return sites;
}

std::string trouble_with_site_name(std::string_view name) {
    if (name.empty()) return "the name of the site is empty";
    if (!is_utf8(name)) return "the name of the site is not UTF-8; allowed: UTF-8";
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    if (is_blank(name.front()) || is_blank(name.back()))
        return "the name of the site begins or ends with a blank; leave it out";
    const auto [trouble, allowed] = trouble_with_characters(name);
    return trouble.empty() ? ""
                           : fmt::format("the name of the site {}; allowed: {}", trouble, allowed);
}

Metres distance(const Site& site, Degrees latitude, Degrees longitude) {
    constexpr double kEarthRadius_m = 6371000.0;
    const double phi_1 = kRadPerDeg * latitude.value(), phi_2 = kRadPerDeg * site.latitude.value();
    const double half_phi = 0.5 * (phi_2 - phi_1);
    const double half_lambda = 0.5 * kRadPerDeg * (site.longitude - longitude).value();
    const double h = std::pow(std::sin(half_phi), 2) +
                     std::cos(phi_1) * std::cos(phi_2) * std::pow(std::sin(half_lambda), 2);
    return Metres(2.0 * kEarthRadius_m * std::asin(std::min(1.0, std::sqrt(h))));
}

const Site* find_site(const std::vector<Site>& sites, std::string_view name) {
    const auto found = std::ranges::find(sites, plain_text(name), &Site::name);
    return found == sites.end() ? nullptr : &*found;
}

const Site& required_site(const std::vector<Site>& sites, const std::string& name) {
    if (const Site* const site = find_site(sites, name)) return *site;
    throw InputError(fmt::format("site {}: unknown; allowed: a name of the table of sites", name));
}

const Site* similar_site(const std::vector<Site>& sites, std::string_view name) {
    const Site* similar = nullptr;
    const std::string wanted = bare(plain_text(name));
    if (wanted.empty()) return nullptr;
    for (const Site& site : sites) {
        if (bare(site.name) != wanted) continue;
        if (similar != nullptr) return nullptr;
        similar = &site;
    }
    return similar;
}

}  // namespace a351::text
