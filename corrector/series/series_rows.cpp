#include "corrector/series/series_rows.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/model/whole_day_model.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::series {

void CheckedSeries::refuse(const std::string& trouble, const std::string& allowed) const {
    throw InputError(fmt::format("{}: {}: {}; allowed: {}", origin, name, trouble, allowed));
}

void CheckedSeries::require_one_point() const {
    for (const reading::SurveyRow& row : read.rows)
        if (row.site != read.rows.front().site)
            refuse(fmt::format("set-ups at {} and {}", read.rows.front().site, row.site),
                   "one point");
}

void CheckedSeries::require_day() const {
    const reading::DayRecord* const day = read.day ? &*read.day : nullptr;
    if (const auto refusal =
            model::day_refusal(read.rows, std::vector<bool>(read.rows.size(), true), day))
        refuse(*refusal, "a record without this");
}

std::size_t CheckedSeries::set_ups() const {
    return static_cast<std::size_t>(std::ranges::count_if(read.rows, is_in_series));
}

MilliGal CheckedSeries::gravity() const {
    return read.rows.front().reference.value_or(MilliGal(kMilliGalPerStandardGravity));
}

std::vector<whole_day::DayStation> CheckedSeries::stations() const {
    std::vector<whole_day::DayStation> stations;
    for (std::size_t i = 0; i < read.rows.size(); ++i)
        stations.push_back(is_in_series(read.rows[i]) ? whole_day::DayStation{gravity(), 0}
                                                      : whole_day::DayStation{std::nullopt, i + 1});
    return stations;
}

}  // namespace a351::corrector::series
