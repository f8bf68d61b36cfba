#include "protocol/text/sites.hpp"

#include <algorithm>

#include "protocol/text/csv.hpp"

namespace a351::text {

std::vector<Site> read_sites(const std::filesystem::path& file) {
    const CsvTable table = read_csv(file);
    std::vector<Site> sites;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const std::string& name = table.cell(row, "site");
        if (name.empty()) table.refuse(row, "site", "empty", "a name");
        if (find_site(sites, name) != nullptr) {
            table.refuse(row, "site", "stands twice", "each site once");
        }
        Site site;
        site.name = name;
        site.longitude = Degrees(table.number(row, "longitude_deg", -180.0, 360.0));
        site.latitude = Degrees(table.number(row, "latitude_deg", -90.0, 90.0));
        site.altitude = Metres(table.number(row, "altitude_m", -500.0, 9000.0));
        // Gravity on the Earth's surface: 976 400 (Huascaran) to 983 400 mGal (Arctic Ocean).
        if (const auto gravity = table.number_if_given(row, "gravity_mgal", 976000.0, 984000.0)) {
            site.gravity = MilliGal(*gravity);
        }
        sites.push_back(std::move(site));
    }
    return sites;
}

const Site* find_site(const std::vector<Site>& sites, std::string_view name) {
    const auto found = std::find_if(sites.begin(), sites.end(),
                                    [name](const Site& site) { return site.name == name; });
    return found == sites.end() ? nullptr : &*found;
}

}  // namespace a351::text
