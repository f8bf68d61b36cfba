#include "corrector/reading/survey_row.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "protocol/core/input_error.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

using std::chrono::minutes;

struct TimeColumn {
    std::string_view name;
    std::optional<minutes> zone;  ///< Zone of cells without one; absent: cells must have one.
};
constexpr std::array<TimeColumn, 3> kTimeColumns{{
    {"time_utc", minutes(0)},
    {"time_jst", minutes(9 * 60)},  // Japan Standard Time, no daylight saving
    {"time", std::nullopt},
}};

const TimeColumn& time_column(const text::CsvTable& table, const std::filesystem::path& file) {
    const TimeColumn* found = nullptr;
    for (const TimeColumn& column : kTimeColumns) {
        if (!table.has_column(column.name)) continue;
        if (found != nullptr) {
            throw InputError(fmt::format("{}:1: columns {} and {}; allowed: one of them",
                                         file.string(), found->name, column.name));
        }
        found = &column;
    }
    if (found == nullptr) {
        throw InputError(file.string() +
                         ":1: no column of time; allowed: time_utc, time_jst or time");
    }
    return *found;
}

UtcTime time_of(const text::CsvTable& table, std::size_t row, const TimeColumn& column) {
    const std::string& cell = table.cell(row, column.name);
    const auto time = column.zone ? parse_rfc3339_in_zone(cell, *column.zone) : parse_rfc3339(cell);
    if (!time) table.refuse(row, column.name, "not an instant", "YYYY-MM-DDThh:mm:ss with zone");
    return *time;
}

int whole_number(const text::CsvTable& table, std::size_t row, std::string_view column, int low,
                 int high) {
    const double value = table.number(row, column, low, high);
    const int whole = static_cast<int>(value);
    if (static_cast<double>(whole) != value)
        table.refuse(row, column, "not whole", "a whole number");
    return whole;
}

/// Least reading of a gravimeter, mGal.  Reason: its zero is anywhere in its range, and the range of
/// a gravimeter for the whole Earth is 8000 mGal.
constexpr double kLeastGravimeterReading_mgal = -20e3;

/// Greatest scatter of the readings of a row, mGal.  Reason: beyond it the row is worthless.
constexpr double kGreatestScatter_mgal = 1000.0;

/// Returns sd_mgal / sqrt(readings); 0 if the scatter is not given.
MilliGal u_average(const text::CsvTable& table, std::size_t i) {
    if (!table.has_column("sd_mgal") || table.cell(i, "sd_mgal").empty()) return MilliGal(0.0);
    const double sd = table.number(i, "sd_mgal", 0.0, kGreatestScatter_mgal);
    const int count =
        table.has_column("readings") ? whole_number(table, i, "readings", 1, 1'000'000) : 1;
    return MilliGal(sd / std::sqrt(static_cast<double>(count)));
}

/// Reads the columns of a gravimeter.
void set_gravimeter(SurveyRow& row, const text::CsvTable& table, std::size_t i) {
    row.instrument = table.cell(i, "instrument");
    if (const std::string trouble = text::trouble_with_site_name(row.instrument); !trouble.empty())
        table.refuse(i, "instrument", "not a name", trouble);
    if (table.has_column("loop")) row.loop = whole_number(table, i, "loop", 0, 1'000'000);
    row.has_temperature =
        table.has_column("temperature_degc") && !table.cell(i, "temperature_degc").empty();
}

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
    // An oven keeps its temperature within 1 degC.  Without one half of the rows are some degrees from
    // the median, so that 20 times as far is beyond any weather.
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

/// Returns true for a table that is grouped by site: there the rows of a site are not in order of the
/// others.
bool are_by_site(const std::vector<SurveyRow>& rows) {
    std::vector<const SurveyRow*> of_table;
    for (const SurveyRow& row : rows) of_table.push_back(&row);
    std::ranges::stable_sort(of_table, {}, &SurveyRow::table_row);
    std::set<std::string> sites;
    std::size_t groups = 0;
    for (std::size_t k = 0; k < of_table.size(); ++k) {
        sites.insert(of_table[k]->site);
        if (k == 0 || of_table[k]->site != of_table[k - 1]->site) ++groups;
    }
    return groups == sites.size() && groups > 1 && groups < rows.size();
}

std::vector<text::Message> order_warnings(const std::vector<SurveyRow>& rows) {
    constexpr std::chrono::hours kNear(8), kHalfDay(12);
    constexpr std::chrono::days kOne(1);  // A difference of days holds any two times.
    const auto day = [](const SurveyRow& row) -> std::chrono::sys_days {
        return std::chrono::floor<std::chrono::days>(row.time);
    };
    std::vector<text::Message> warnings;
    const bool is_by_site = are_by_site(rows);
    std::map<std::string, const SurveyRow*> last;  // of each instrument
    for (const SurveyRow& row : rows) {
        const SurveyRow*& before = last[row.instrument];
        if (before != nullptr && before->table_row > row.table_row && !is_by_site &&
            day(row) - day(*before) <= kOne && row.time - before->time <= kHalfDay)
            warnings.push_back(text::message(
                "{} ({}), {}, is earlier than {} ({}), {}, but below it in the table: check hours "
                "and zone of both",
                before->site, before->occupation, to_rfc3339(before->time), row.site,
                row.occupation, to_rfc3339(row.time)));
        before = &row;
    }
    warnings = unless_many(std::move(warnings), rows.size());
    if (!warnings.empty()) return warnings;
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

std::vector<text::Message> reference_warnings(const std::vector<SurveyRow>& rows) {
    constexpr MilliGal kWorst(1.0);
    std::set<std::string> sites;
    MilliGal u = kWorst;
    for (const SurveyRow& row : rows) {
        if (row.u_reference.value_or(kWorst) > kWorst) sites.insert(row.site);
        u = std::max(u, row.u_reference.value_or(kWorst));
    }
    if (sites.empty()) return {};
    return {
        text::message("{}: gravity is known to {} mGal only; or is u_gravity_mgal in microgals?",
                      text::joined({sites.begin(), sites.end()}), text::shortest(u.value()))};
}

}  // namespace

std::optional<Metres> instrument_height(const text::CsvTable& table, std::size_t row) {
    const auto height_m = table.number_if_given(
        row, "instrument_height_m", -kGreatestInstrumentHeight_m, kGreatestInstrumentHeight_m);
    return height_m ? std::optional(Metres(*height_m)) : std::nullopt;
}

std::string stay_name(const std::string& site, int occupation) {
    return fmt::format("{} ({})", site, occupation);
}

const RecordSummary& SurveyRow::axes_for(std::string_view wanted_by) const {
    if (record) return *record;
    throw InputError(fmt::format("{}: {} ({}) has no mean_x_g; allowed: rows from records",
                                 wanted_by, site, occupation));
}

std::vector<SurveyRow> read_observations(const std::filesystem::path& file,
                                         const std::vector<text::Site>& sites) {
    const text::CsvTable table = text::read_csv(file);
    const TimeColumn& column = time_column(table, file);
    const bool is_of_gravimeter = table.has_column("instrument");
    std::vector<SurveyRow> rows;
    for (std::size_t i = 0; i < table.row_count(); ++i) {
        SurveyRow row;
        row.table_row = i;
        if (is_of_gravimeter) set_gravimeter(row, table, i);
        row.site = table.cell(i, "site");
        const text::Site* const site = text::find_site(sites, row.site);
        if (site == nullptr) table.refuse(i, "site", "unknown", "a name of the table of sites");
        row.reference = site->gravity;
        row.u_reference = site->u_gravity;
        row.occupation = whole_number(table, i, "occupation", 1, 1'000'000);
        row.time = time_of(table, i, column);
        if (table.has_column("outlier")) row.is_flagged = whole_number(table, i, "outlier", 0, 1);
        if (table.has_column("earth_tide_mgal")) {
            // No solid-Earth tide exceeds 0.3 mGal; the limit 1 finds a wrong unit.
            row.given_tide = MilliGal(table.number(i, "earth_tide_mgal", -1.0, 1.0));
            if (table.has_column("tide_system"))
                row.given_tide_system = table.cell(i, "tide_system");
        }
        // Gravity on Earth is 976000-984000 mGal, biases are some thousands.
        row.acceleration = MilliGal(table.unrounded(
            i, "acceleration_mgal", is_of_gravimeter ? 0.001 : text::kMostOfLastDigit_mgal,
            is_of_gravimeter ? kLeastGravimeterReading_mgal : 900e3, 1100e3));
        row.u_average = u_average(table, i);
        if (row.has_temperature)
            row.temperature = DegC(table.number(i, "temperature_degc", -60.0, 100.0));
        if (table.has_column("instrument_height_m"))
            row.instrument_height = instrument_height(table, i);
        if (table.has_column("pressure_hpa"))
            row.pressure_hpa =
                table.number_if_given(i, "pressure_hpa", kLeastPressure_hpa, kGreatestPressure_hpa);
        if (i > 0 && row.has_temperature != rows.front().has_temperature)
            table.refuse(i, "temperature_degc", "given in some rows only", "all rows or none");
        if (std::ranges::any_of(rows, [&](const SurveyRow& other) {
                return other.time == row.time && other.instrument == row.instrument;
            }))
            table.refuse(i, column.name, "appears twice", "one row per instant");
        rows.push_back(std::move(row));
    }
    if (rows.empty()) throw InputError(file.string() + ": no rows; allowed: at least one");
    std::ranges::stable_sort(rows, {}, &SurveyRow::time);
    if (!is_of_gravimeter) set_backward_rates(rows);
    return rows;
}

void set_backward_rates(std::vector<SurveyRow>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].rate_degc_per_h =
            i == 0 ? 0.0
                   : (rows[i].temperature - rows[i - 1].temperature).value() /
                         (seconds_between(rows[i - 1].time, rows[i].time) / kSecondsPerHour);
    }
}

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
    for (auto* const more : {&temperature_warnings, &order_warnings, &reference_warnings})
        std::ranges::move(more(rows), std::back_inserter(warnings));
    return warnings;
}

}  // namespace a351::corrector::reading
