#include "daemon/survey/site_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <system_error>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::daemon::survey {
namespace {

/// @throws InputError  the value is not within the limits.
void require_within(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw InputError(fmt::format("{} = {}: out of range; allowed: {} to {}", name,
                                 text::shortest(value), text::shortest(low), text::shortest(high)));
}

/// Checks what only a new site must meet.
void require_allowed(const text::Site& site, const std::vector<text::Site>& list) {
    if (const auto trouble = text::trouble_with_site_name(site.name); !trouble.empty())
        throw InputError(trouble);
    if (text::find_site(list, site.name))
        throw InputError(fmt::format("the site {} is in the list already", site.name));
    require_within("latitude_deg", site.latitude.value(), -90.0, 90.0);
    require_within("longitude_deg", site.longitude.value(), -180.0, 360.0);
    if (site.has_altitude)
        require_within("altitude_m", site.altitude.value(), text::kLeastAltitude_m,
                       text::kGreatestAltitude_m);
    if (site.gravity)
        require_within("gravity_mgal", site.gravity->value(), text::kLeastGravity_mgal,
                       text::kGreatestGravity_mgal);
}

/// Returns the row of the site in the columns of this list, without a line end.
std::string row_of(const text::Site& site, const std::string& list,
                   const std::filesystem::path& file) {
    std::map<std::string, std::string> cells{
        {"site", site.name},
        {"longitude_deg", text::shortest(site.longitude.value())},
        {"latitude_deg", text::shortest(site.latitude.value())}};
    if (site.has_altitude) cells["altitude_m"] = text::shortest(site.altitude.value());
    if (site.gravity) cells["gravity_mgal"] = text::shortest(site.gravity->value());
    std::istringstream in(list);
    std::vector<std::string> row;
    const text::CsvReader reader(in, file);
    if (reader.is_utf16())
        throw InputError(fmt::format("{}: UTF-16, to which no site can be added; allowed: UTF-8{}",
                                     file.string(), text::kHowToSave));
    const bool has_commas = text::CsvTable::parse(list, file).decimal_sign().sign() == ',';
    for (const std::string& column : reader.columns()) {
        row.push_back(cells[column]);
        if (has_commas && column != "site") std::ranges::replace(row.back(), '.', ',');
        // A quotation mark is in no name of a site.
        if (row.back().find(reader.separator()) != std::string::npos)
            row.back() = '"' + row.back() + '"';
    }
    return fmt::format("{}", fmt::join(row, std::string(1, reader.separator())));
}

}  // namespace

std::vector<text::Site> append_site(files::FileLayer& files, const std::filesystem::path& file,
                                    const text::Site& site) {
    namespace fs = std::filesystem;
    const fs::path target = fs::canonical(file);
    std::string list = text::read_text_file(target);
    require_allowed(site, text::parse_sites(list, file));
    const std::string line_end = list.find("\r\n") == std::string::npos ? "\n" : "\r\n";
    const std::string row = row_of(site, list, file) + line_end;
    if (!list.ends_with('\n')) list += line_end;
    list += row;
    auto sites = text::parse_sites(list, file);
    const fs::perms permissions = fs::status(target).permissions();
    files::replace_file(files, target, std::as_bytes(std::span(list)));
    std::error_code refused;  // The row is in the list, also where permissions cannot be set.
    fs::permissions(target, permissions, refused);
    return sites;
}

}  // namespace a351::daemon::survey
