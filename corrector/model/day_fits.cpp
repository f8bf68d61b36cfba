#include "corrector/model/day_fits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "corrector/reading/on_all_cores.hpp"

namespace a351::corrector::model {
namespace {

/// Returns the stations of a fit.  Held is the reference of rows in use, except those of
/// `left_out`.
std::vector<whole_day::DayStation> stations_of(const std::vector<reading::SurveyRow>& rows,
                                               const RowChoice& choice,
                                               const std::string& left_out) {
    std::vector<whole_day::DayStation> stations;
    std::map<std::string, std::size_t> numbers;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const reading::SurveyRow& row = rows[i];
        const std::string name =
            choice.accepted[i] ? "station " + row.site : fmt::format("row {}", i);
        whole_day::DayStation station{row.tide, std::nullopt,
                                      numbers.emplace(name, numbers.size()).first->second,
                                      row.u_reference.value_or(MilliGal(0.0))};
        if (choice.in_use[i] && row.site != left_out) station.gravity = row.reference;
        stations.push_back(station);
    }
    return stations;
}

}  // namespace

const Fitted* DayFits::without(const std::string& site) const {
    const auto found = std::ranges::find(left_out, site);
    return found == left_out.end() ? nullptr : others.data() + (found - left_out.begin());
}

const Fitted* DayFits::with_unknown(std::size_t row, const std::string& site) const {
    return all.stations[row].gravity ? without(site) : &all;
}

DayFits fit_with_and_without(const SurveyProblem& problem, const RowChoice& choice,
                             const whole_day::DayPriors& priors) {
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    const reading::DayRecord& day = *problem.day;
    DayFits fits;
    fits.all.stations = stations_of(rows, choice, "");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string& site = rows[i].site;
        if (choice.in_use[i] && std::ranges::find(fits.left_out, site) == fits.left_out.end())
            fits.left_out.push_back(site);
    }
    if (fits.left_out.size() < 2)
        fits.left_out.clear();  // without the only one, no station would be held
    for (const std::string& site : fits.left_out)
        fits.others.push_back({stations_of(rows, choice, site), {}});
    fits.all.fit = whole_day::fit_day(day, fits.all.stations, nullptr, priors).value();
    reading::on_all_cores(fits.others.size(), [&](std::size_t k) {
        Fitted& other = fits.others[k];
        other.fit = whole_day::fit_day(day, other.stations, &fits.all.fit, priors).value();
    });
    return fits;
}

}  // namespace a351::corrector::model
