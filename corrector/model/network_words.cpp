#include "corrector/model/network_words.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

using adjustment::AdjustedSurvey;
using adjustment::SurveyEquations;

std::string named(const SurveyEquations& survey, const std::set<std::size_t>& stations) {
    std::vector<std::string> names;
    for (const std::size_t station : stations) names.push_back(survey.stations()[station].site);
    return text::joined(names);
}

bool holds_datum(const SurveyEquations& survey, const std::set<std::size_t>& stations) {
    return std::ranges::any_of(
        stations, [&](std::size_t station) { return survey.stations()[station].held.has_value(); });
}

/// Returns the groups of stations that no chain of stations and loops connects with a datum, as one
/// text of joined names per group; empty if there are none.
std::vector<std::string> unconnected_groups(const SurveyEquations& survey) {
    // The stations of a loop are connected, because they share its constant: merge their groups.
    std::vector<std::size_t> group(survey.stations().size());
    std::iota(group.begin(), group.end(), std::size_t(0));
    std::map<std::size_t, std::size_t> first_of_loop;
    for (const adjustment::ReadingRow& reading : survey.readings()) {
        const std::size_t station = *reading.station;
        const auto [first, is_new] = first_of_loop.emplace(*survey.loops()[reading.row], station);
        if (is_new) continue;
        const std::size_t from = group[station], to = group[first->second];
        std::ranges::replace(group, from, to);
    }
    std::map<std::size_t, std::set<std::size_t>> members;
    for (std::size_t station = 0; station < group.size(); ++station)
        members[group[station]].insert(station);
    std::vector<std::string> groups;
    for (const auto& [id, stations] : members)
        if (!holds_datum(survey, stations)) groups.push_back(named(survey, stations));
    return groups;
}

/// Returns the groups of stations that only the instrument's constant and drift connect with a
/// datum, because no station is occupied both before and after.
std::vector<std::string> groups_tied_by_drift(const SurveyEquations& survey) {
    std::map<std::size_t, std::size_t> last_reading;
    for (std::size_t i = 0; i < survey.readings().size(); ++i)
        last_reading[*survey.readings()[i].station] = i;
    std::vector<std::string> groups;
    std::set<std::size_t> group;
    std::size_t last = 0;
    for (std::size_t i = 0; i < survey.readings().size(); ++i) {
        const std::size_t station = *survey.readings()[i].station;
        group.insert(station);
        last = std::max(last, last_reading[station]);
        // A group ends if none of its stations is occupied again later.
        if (last > i) continue;
        if (!holds_datum(survey, group)) groups.push_back(named(survey, group));
        group.clear();
    }
    return groups;
}

/// Returns true if a station was read twice in one loop.
bool has_repeat(const SurveyEquations& survey) {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    return std::ranges::any_of(survey.readings(), [&](const adjustment::ReadingRow& reading) {
        return !seen.emplace(*survey.loops()[reading.row], *reading.station).second;
    });
}

/// Says where the loops of gravimeters begin; nothing with one loop.
text::Message loops_remark(const SurveyEquations& survey) {
    std::vector<bool> is_named(survey.loop_count(), false);
    text::Message remark;
    std::size_t count = 0;
    for (std::size_t i = 0; i < survey.rows().size(); ++i) {
        const reading::SurveyRow& row = survey.rows()[i];
        if (!survey.loops()[i] || row.instrument.empty() || is_named[*survey.loops()[i]]) continue;
        const std::size_t loop = *survey.loops()[i];
        is_named[loop] = true;
        const std::string from = to_rfc3339(survey.origin_of(loop));
        remark += count++ == 0
                      ? text::message("loop {} is {} from {}", loop + 1, row.instrument, from)
                      : text::message("; loop {} is {} from {}", loop + 1, row.instrument, from);
    }
    return count > 1 ? remark : text::Message();
}

/// Correlation of the pressure with the readings, over the rows in use.
double pressure_correlation(const std::vector<CorrectedRow>& rows) {
    double n = 0.0, p = 0.0, g = 0.0, pp = 0.0, gg = 0.0, pg = 0.0;
    for (const CorrectedRow& of : rows) {
        const reading::SurveyRow& row = of.row;
        if (!of.is_used || !row.pressure_hpa) continue;
        // From the first row, to keep the digits.
        const double x = *row.pressure_hpa - rows.front().row.pressure_hpa.value_or(0.0);
        const double y = (row.measured() - row.tide - rows.front().row.measured()).value();
        n += 1.0;
        p += x;
        g += y;
        pp += x * x;
        gg += y * y;
        pg += x * y;
    }
    return (pg - p * g / n) / std::sqrt((pp - p * p / n) * (gg - g * g / n));
}

}  // namespace

Refusal undetermined(const AdjustedSurvey& adjusted) {
    const SurveyEquations& survey = adjusted.survey;
    std::vector<std::string> names;
    bool has_drift = false;
    for (const std::size_t k : adjusted.adjustment.undetermined()) {
        if (k < survey.stations().size()) {
            names.push_back(survey.stations()[k].site);
            continue;
        }
        const adjustment::SurveyTerm& term = survey.terms()[k - survey.stations().size()];
        names.push_back(term.name);
        has_drift = has_drift || term.name.starts_with("time");
    }
    return {fmt::format("the readings do not determine {}: {}", text::joined(names),
                        has_repeat(survey)
                            ? "there are fewer repeated readings than coefficients to determine"
                            : fmt::format("every station is occupied only once in its loop, "
                                          "and a pause of more than {} h begins a loop",
                                          std::lround(adjustment::kLoopPause_h))),
            has_drift ? "further occupations of a station at other times, more datum stations, a "
                        "prior on time_mgal_per_h, or a smaller drift_degree"
                      : "further occupations, more datum stations, or a prior on a coefficient"};
}

std::optional<Refusal> refusal_of(const SurveyEquations& survey) {
    for (const adjustment::EquationStation& station : survey.stations())
        if (!station.held && std::ranges::find(survey.knowledge().datum, station.site) !=
                                 survey.knowledge().datum.end())
            return Refusal{fmt::format("datum = {}: no reference gravity", station.site),
                           "stations with gravity_mgal"};
    std::set<std::size_t> all;
    for (std::size_t k = 0; k < survey.stations().size(); ++k) all.insert(k);
    if (all.empty()) return Refusal{"no reading in use", "at least one"};
    if (!holds_datum(survey, all))
        return Refusal{
            "no datum: none of the stations in use has a reference that is held, so the "
            "constant is undetermined",
            fmt::format("gravity_mgal of at least one occupied station ({})", named(survey, all))};
    if (const auto groups = unconnected_groups(survey); !groups.empty())
        return Refusal{
            fmt::format("unconnected: no chain of stations and loops joins a datum to {}",
                        text::joined(groups, "; ")),
            "a datum in every group, or its rows taken out of use"};
    return std::nullopt;
}

void add_remarks(NetworkResult& result) {
    const SurveyEquations& survey = result.adjusted->survey;
    if (text::Message loops = loops_remark(survey); !loops.empty())
        result.remarks.push_back(std::move(loops));
    const std::vector<std::string> tied = groups_tied_by_drift(survey);
    if (!tied.empty())
        result.remarks.push_back(text::message(
            "connected with a datum only by the instrument's constant and drift, because no "
            "station is occupied before and after: {}",
            text::joined(tied, "; ")));
    // Datum rows are not checked: their redundancy is always small, because a wrong reference shows
    // in the residuals of the readings.
    std::vector<std::string> uncontrolled;
    for (std::size_t i = 0; i < result.part.reading_count; ++i)
        if (result.part.rows[i].redundancy < kControlledRedundancy)
            uncontrolled.push_back(result.part.rows[i].label);
    if (!uncontrolled.empty())
        result.remarks.push_back(text::message(
            "practically uncontrolled (redundancy below 0.1), a blunder there cannot be found: {}",
            text::joined(uncontrolled)));
}

text::Message admittance_remark(const Fit& result) {
    // Real admittances are -0.0002 to -0.0004 mGal/hPa: a value whose error is larger than half
    // this range is not better than the usual one.
    constexpr double kUsual_mgal_per_hpa = -0.0003, kGoodError_mgal_per_hpa = 0.0001;
    const Coefficient& admittance =
        *std::ranges::find(result.coefficients, adjustment::kAdmittance.name, &Coefficient::name);
    const double u = admittance.standard_error.value();
    return text::message(
        "admittance {:.5f} +- {:.5f} mGal/hPa, fitted; pressure and readings correlate by {:.3f}{}",
        admittance.value, u, pressure_correlation(result.rows),
        u <= kGoodError_mgal_per_hpa
            ? text::Message()
            : text::message(": it cannot be distinguished from gravity and drift, use the fixed {}",
                            kUsual_mgal_per_hpa));
}

}  // namespace a351::corrector::model
