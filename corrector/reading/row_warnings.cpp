#include "corrector/reading/row_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

/// Removes the warnings if they are about more than a quarter of the rows.
std::vector<text::Message> unless_many(std::vector<text::Message> warnings, std::size_t rows) {
    if (4 * warnings.size() > rows) warnings.clear();
    return warnings;
}

std::vector<text::Message> time_warnings(const std::vector<SurveyRow>& rows) {
    using Day = std::chrono::sys_days;  // A difference of days holds any two times.
    constexpr std::chrono::days kFar(20);
    const auto day = [&rows](std::size_t i) -> Day {
        return std::chrono::floor<std::chrono::days>(rows[i].time);
    };
    std::vector<text::Message> warnings;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::chrono::days least = std::chrono::days::max();
        if (i > 0) least = day(i) - day(i - 1);
        if (i + 1 < rows.size()) least = std::min(least, day(i + 1) - day(i));
        if (least > kFar)
            warnings.push_back(text::message(
                "{} ({}): {} is {} days from every other reading: check its year and month",
                rows[i].site, rows[i].occupation, to_rfc3339(rows[i].time), least.count()));
    }
    return unless_many(std::move(warnings), rows.size());
}

std::vector<text::Message> temperature_warnings(const std::vector<SurveyRow>& rows) {
    constexpr double kFar_degc = 10.0, kFar = 20.0;
    if (rows.empty() || !rows.front().has_temperature) return {};
    std::vector<double> values_degc, distances_degc;
    for (const SurveyRow& row : rows) values_degc.push_back(row.temperature.value());
    const double median_degc = signal::median(values_degc);
    for (const double value : values_degc) distances_degc.push_back(std::abs(value - median_degc));
    const double far_degc = std::max(kFar_degc, kFar * signal::median(distances_degc));
    std::vector<text::Message> warnings;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (distances_degc[i] > far_degc)
            warnings.push_back(text::message(
                "{} ({}): its temperature of {} degC is far from the median of {} degC: check it",
                rows[i].site, rows[i].occupation, text::fixed(values_degc[i], 2),
                text::fixed(median_degc, 2)));
    return unless_many(std::move(warnings), rows.size());
}

std::vector<text::Message> order_warnings(const std::vector<SurveyRow>& rows) {
    constexpr std::chrono::hours kNear(8);
    constexpr std::chrono::days kOne(1);  // A difference of days holds any two times.
    const auto day = [](const SurveyRow& row) -> std::chrono::sys_days {
        return std::chrono::floor<std::chrono::days>(row.time);
    };
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = i; k > 0 && day(rows[i]) - day(rows[k - 1]) <= kOne; --k) {
            const SurveyRow &row = rows[i], &before = rows[k - 1];
            if (before.loop == row.loop && before.site == row.site &&
                before.instrument == row.instrument && before.occupation > row.occupation &&
                row.time - before.time < kNear)
                return {text::message(
                    "{} ({}), {}, is later than {} ({}), {}: check hours and zone of both",
                    row.site, row.occupation, to_rfc3339(row.time), before.site, before.occupation,
                    to_rfc3339(before.time))};
        }
    return {};
}

}  // namespace

std::vector<text::Message> position_warnings(const std::vector<SurveyRow>& rows,
                                             const std::vector<text::Site>& sites) {
    std::vector<text::Message> warnings;
    for (const SurveyRow& row : rows) {
        const text::Site* const site = text::find_site(sites, row.site);
        if (site == nullptr || (site->is_placed && site->has_altitude)) continue;
        text::Message warning =
            site->is_placed
                ? text::message(
                      "{}: no height in the table of sites; the mean of the others is used",
                      row.site)
                : text::message(
                      "{}: no position in the table of sites; the mean of the others is used",
                      row.site);
        if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
            warnings.push_back(std::move(warning));
    }
    return warnings;
}

std::vector<text::Message> row_warnings(const std::vector<SurveyRow>& rows) {
    std::vector<text::Message> warnings = time_warnings(rows);
    for (auto* const more : {&temperature_warnings, &order_warnings})
        std::ranges::move(more(rows), std::back_inserter(warnings));
    return warnings;
}

}  // namespace a351::corrector::reading
