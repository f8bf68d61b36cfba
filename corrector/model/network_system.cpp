#include "corrector/model/network_system.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "corrector/model/model_fit.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

/// Loops that have a reading in use.
struct Loops {
    std::vector<std::optional<std::size_t>> of;  ///< Loop of every row; absent in other loops.
    std::size_t count = 0;
};

Loops find_loops(const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& in_use) {
    const std::vector<std::size_t> all = loop_numbers(rows);
    std::vector<bool> is_used(rows.size(), false);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (in_use[i]) is_used[all[i]] = true;
    Loops loops;
    std::vector<std::optional<std::size_t>> number;
    for (const bool one : is_used)
        number.push_back(one ? std::optional(loops.count++) : std::nullopt);
    for (const std::size_t loop : all) loops.of.push_back(number[loop]);
    return loops;
}

bool temperature_varies(const std::vector<reading::SurveyRow>& rows,
                        const std::vector<bool>& in_use) {
    std::optional<DegC> first;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        if (!first) first = rows[i].temperature;
        if (rows[i].temperature != *first) return true;
    }
    return false;
}

/// Returns the column of a step: 1 for the rows of its loop after it.  It is 0 if the loop has no
/// reading in use before or after it.
Eigen::VectorXd step_column(const std::vector<reading::SurveyRow>& rows,
                            const std::vector<bool>& in_use, const Loops& loops, const Step& step) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(std::ssize(rows));
    const auto after =
        std::ranges::find_if(rows, [&](const auto& row) { return step.is_before(row); });
    if (after == rows.end()) return column;
    const auto loop = loops.of[static_cast<std::size_t>(after - rows.begin())];
    bool is_seen_before = false, is_seen_after = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (loops.of[i] != loop) continue;
        const bool is_after = step.is_before(rows[i]);
        if (is_after) column(static_cast<Eigen::Index>(i)) = 1.0;
        if (in_use[i]) (is_after ? is_seen_after : is_seen_before) = true;
    }
    if (!is_seen_before || !is_seen_after) column.setZero();
    return column;
}

/// Returns the scale of a row's instrument; null if its loop has no reading in use.
const NetworkScale* scale_of(const NetworkAdjustment& network, const reading::SurveyRow& row) {
    const auto at = std::ranges::find(network.scales, row.instrument, &NetworkScale::instrument);
    return at == network.scales.end() ? nullptr : &*at;
}

/// Appends a row to the system and returns its line of `a`, filled with 0.
Eigen::MatrixXd::RowXpr add_row(NetworkSystem& system, NetworkAdjustment& network,
                                std::string label, double sd, double value) {
    auto& [a, y] = system;
    a.conservativeResize(a.rows() + 1, Eigen::NoChange);
    y.conservativeResize(y.size() + 1);
    a.bottomRows(1).setZero();
    y(y.size() - 1) = value;
    network.rows.push_back({std::move(label), 0.0, sd, 0.0});
    return a.row(a.rows() - 1);
}

}  // namespace

std::vector<std::size_t> loop_numbers(const std::vector<reading::SurveyRow>& rows) {
    std::map<std::string, std::size_t> last_of;
    std::vector<std::size_t> loops;
    std::size_t count = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto last = last_of.find(rows[i].instrument);
        const bool continues = last != last_of.end() && rows[last->second].loop == rows[i].loop &&
                               seconds_between(rows[last->second].time, rows[i].time) <=
                                   kLoopPause_h * kSecondsPerHour;
        loops.push_back(continues ? loops[last->second] : count++);
        last_of[rows[i].instrument] = i;
    }
    return loops;
}

double sd_mgal_of(const reading::SurveyRow& row, const Priors& priors) {
    return std::hypot(priors.reading_sd_mgal, row.u_average.value());
}

void set_terms(NetworkAdjustment& network, const std::vector<reading::SurveyRow>& rows,
               const std::vector<bool>& in_use, const Priors& priors,
               const NetworkOptions& options) {
    const int drift_degree = options.drift_degree;
    const Loops loops = find_loops(rows, in_use);
    const auto add = [&](TermKind kind, const std::string& coefficient,
                         const std::string& suffix = "") {
        const Prior* const prior = priors.find(coefficient);
        network.terms.push_back(
            {kind, coefficient + suffix, prior == nullptr ? std::nullopt : std::optional(*prior)});
    };
    for (std::size_t loop = 0; loop < loops.count; ++loop) {
        // From the second loop on, the names have the number of the loop.
        const std::string suffix = loop == 0 ? "" : fmt::format("_loop{}", loop + 1);
        add(TermKind::constant, "constant_mgal", suffix);
        if (drift_degree >= 1) add(TermKind::drift, "time_mgal_per_h", suffix);
        for (int k = 2; k <= drift_degree; ++k)
            add(TermKind::drift, fmt::format("time{0}_mgal_per_h{0}", k), suffix);
    }
    const bool has_temperature =
        temperature_varies(rows, in_use) || priors.find("temperature_mgal_per_degc") != nullptr;
    const bool has_rate = priors.find("rate_mgal_per_degc_per_h") != nullptr;
    if (has_temperature)
        add(TermKind::temperature, "temperature_mgal_per_degc");
    else
        network.remarks.push_back(
            rows.front().has_temperature
                ? text::message(
                      "the temperature does not vary between the readings: its coefficient cannot "
                      "be separated from the constant and is left out")
                : text::message("no temperature is given: the readings are taken as corrected for "
                                "it"));
    if (has_rate) add(TermKind::rate, "rate_mgal_per_degc_per_h");
    if (options.fits_admittance) add(TermKind::admittance, "admittance_mgal_per_hpa");
    std::vector<Eigen::VectorXd> steps;
    for (std::size_t k = 0; k < options.steps.size(); ++k) {
        Eigen::VectorXd column = step_column(rows, in_use, loops, options.steps[k]);
        if (column.isZero()) continue;
        add(TermKind::step, fmt::format("step_{}_mgal", k + 1));
        steps.push_back(std::move(column));
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!loops.of[i] || scale_of(network, rows[i]) != nullptr) continue;
        const Prior prior = priors.scale_of(rows[i].instrument);
        const std::size_t count = network.scales.size();
        network.scales.push_back({rows[i].instrument, prior, network.terms.size(), prior.mean});
        network.terms.push_back(
            {TermKind::scale,
             count == 0 ? std::string(kScale) : fmt::format("{}_instrument{}", kScale, count + 1),
             std::nullopt});
    }

    const auto degree = static_cast<Eigen::Index>(drift_degree);
    network.term_columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()),
                                                 static_cast<Eigen::Index>(network.terms.size()));
    std::vector<std::optional<UtcTime>> origins(loops.count);
    text::Message of_gravimeters;
    std::size_t gravimeter_loops = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        network.is_tied.push_back(loops.of[i].has_value());
        if (!loops.of[i]) continue;
        std::optional<UtcTime>& origin = origins[*loops.of[i]];
        if (!origin) {
            origin = rows[i].time;
            if (!rows[i].instrument.empty())
                of_gravimeters += gravimeter_loops++ == 0
                                      ? text::message("loop {} is {} from {}", *loops.of[i] + 1,
                                                      rows[i].instrument, to_rfc3339(*origin))
                                      : text::message("; loop {} is {} from {}", *loops.of[i] + 1,
                                                      rows[i].instrument, to_rfc3339(*origin));
        }
        auto line = network.term_columns.row(static_cast<Eigen::Index>(i));
        const double hours =
            seconds_between(*origin, rows[i].time) / kSecondsPerHour - kReferenceTime_h;
        auto k = static_cast<Eigen::Index>(*loops.of[i]) * (degree + 1);
        line(k) = 1.0;
        for (Eigen::Index power = 1; power <= degree; ++power)
            line(k + power) = line(k + power - 1) * hours;
        k = static_cast<Eigen::Index>(loops.count) * (degree + 1);
        if (has_temperature) line(k++) = (rows[i].temperature - kReferenceTemperature).value();
        if (has_rate) line(k++) = rows[i].rate_degc_per_h;
        if (options.fits_admittance) line(k) = rows[i].excess_pressure_hpa.value_or(0.0);
    }
    if (gravimeter_loops > 1) network.remarks.push_back(of_gravimeters);
    for (std::size_t k = 0; k < steps.size(); ++k)
        network.term_columns.col(network.term_columns.cols() - std::ssize(network.scales) -
                                 std::ssize(steps) + static_cast<Eigen::Index>(k)) = steps[k];
}

void set_scale_columns(NetworkAdjustment& network, const std::vector<reading::SurveyRow>& rows) {
    const auto station_count = std::ssize(network.stations);
    for (NetworkScale& scale : network.scales)
        scale.linearised =
            1.0 + network.unknowns(station_count + static_cast<Eigen::Index>(scale.term));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!network.is_tied[i]) continue;
        const NetworkScale& scale = *scale_of(network, rows[i]);
        const auto at = std::ranges::find(network.stations, rows[i].site);
        double gravity_mgal = (rows[i].acceleration - rows[i].tide - network.origin).value();
        if (at != network.stations.end()) {
            gravity_mgal = network.unknowns(at - network.stations.begin());
        } else {
            for (std::size_t k = 0; k < network.terms.size(); ++k)
                if (k != scale.term) gravity_mgal -= network.effect_mgal(i, k);
            gravity_mgal /= scale.linearised;
        }
        network.term_columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(scale.term)) =
            gravity_mgal;
    }
}

NetworkReadings find_stations(const std::vector<reading::SurveyRow>& rows,
                              const std::vector<bool>& in_use,
                              const std::vector<std::string>& datum) {
    NetworkReadings readings;
    auto& [stations, is_held, station_of, loop_of, references, u_references] = readings;
    const Loops loops = find_loops(rows, in_use);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        const std::string& site = rows[i].site;
        const auto at = std::ranges::find(stations, site);
        station_of.push_back(static_cast<std::size_t>(at - stations.begin()));
        loop_of.push_back(loops.of[i].value());
        if (at != stations.end()) continue;
        stations.push_back(site);
        is_held.push_back(rows[i].is_datum(datum));
        references.push_back(rows[i].reference.value_or(MilliGal(0.0)));
        u_references.push_back(rows[i].u_reference);
    }
    return readings;
}

NetworkSystem build_system(NetworkAdjustment& network, const std::vector<reading::SurveyRow>& rows,
                           const std::vector<bool>& in_use, const NetworkReadings& readings,
                           const Priors& priors, const NetworkOptions& options) {
    const auto& is_held = readings.is_held;
    const auto first_held = std::ranges::find(is_held, true) - is_held.begin();
    network.origin = readings.references[static_cast<std::size_t>(first_held)];
    network.rows.clear();
    network.reading_count = network.datum_count = 0;
    const auto station_count = static_cast<Eigen::Index>(network.stations.size());
    const Eigen::Index term_count = network.term_columns.cols();
    NetworkSystem system{Eigen::MatrixXd(0, station_count + term_count), Eigen::VectorXd(0)};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        const reading::SurveyRow& row = rows[i];
        const std::size_t station = readings.station_of[network.reading_count++];
        auto line = add_row(system, network, fmt::format("{} ({})", row.site, row.occupation),
                            sd_mgal_of(row, priors),
                            (row.acceleration - network.origin - row.tide).value());
        const NetworkScale& scale = *scale_of(network, row);
        line(static_cast<Eigen::Index>(station)) = scale.linearised;
        line.tail(term_count) = network.term_columns.row(static_cast<Eigen::Index>(i));
        system.y(system.y.size() - 1) +=
            line(station_count + static_cast<Eigen::Index>(scale.term)) * (scale.linearised - 1.0);
    }
    for (std::size_t k = 0; k < network.stations.size(); ++k) {
        if (!is_held[k]) continue;
        ++network.datum_count;
        const MilliGal u = readings.u_references[k].value_or(MilliGal(options.datum_sd_mgal));
        auto line = add_row(system, network, "datum " + network.stations[k],
                            std::max(u.value(), kLeastSd_mgal),
                            (readings.references[k] - network.origin).value());
        network.rows.back().held = k;
        line(static_cast<Eigen::Index>(k)) = 1.0;
    }
    for (const NetworkScale& scale : network.scales) {
        auto line = add_row(system, network, "prior " + network.terms[scale.term].name,
                            priors.in_use(network.terms[scale.term].name, scale.prior).sd,
                            scale.prior.mean - 1.0);
        line(station_count + static_cast<Eigen::Index>(scale.term)) = 1.0;
    }
    for (std::size_t k = 0; k < network.terms.size(); ++k) {
        const NetworkTerm& term = network.terms[k];
        if (!term.prior) continue;
        auto line =
            add_row(system, network, "prior " + term.name,
                    priors.in_use(term.name, *term.prior).sd, term.prior->mean);
        line(station_count + static_cast<Eigen::Index>(k)) = 1.0;
    }
    return system;
}

}  // namespace a351::corrector::model
