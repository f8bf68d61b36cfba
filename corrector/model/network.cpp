#include "corrector/model/network.hpp"

#include <fmt/core.h>

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "corrector/model/network_system.hpp"
#include "protocol/linear_algebra/pivoted_qr.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

std::string named(const NetworkReadings& readings, const std::set<std::size_t>& stations) {
    std::vector<std::string> names;
    for (const std::size_t station : stations) names.push_back(readings.stations[station]);
    return text::joined(names);
}

bool holds_datum(const NetworkReadings& readings, const std::set<std::size_t>& stations) {
    return std::ranges::any_of(stations,
                               [&](std::size_t station) { return readings.is_held[station]; });
}

/// Returns the numbers of the unknowns that the rows do not determine: those that have a component
/// in the null space of `design`.
///
/// Columns are scaled to length 1 first, so that units have no effect.  Singular values up to 1e-9
/// of the largest count as 0.  The standard deviations of the rows have no effect and are not
/// needed.
/// @param design  (rows, unknowns), finite; may have fewer rows than unknowns.
std::vector<std::size_t> undetermined_unknowns(const Eigen::MatrixXd& design) {
    // Columns of length 1, so that the unit of a coefficient has no effect on the rank.
    Eigen::MatrixXd scaled = design;
    for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
        const double norm = scaled.col(k).norm();
        if (norm > 0.0) scaled.col(k) /= norm;
    }
    // Zero rows are appended, so that the null space is complete with fewer rows than unknowns.
    const Eigen::Index short_of = std::max<Eigen::Index>(0, scaled.cols() - scaled.rows());
    scaled.conservativeResize(scaled.rows() + short_of, Eigen::NoChange);
    scaled.bottomRows(short_of).setZero();
    // Times and temperatures are rounded to 1e-13 of their range.  No survey can separate columns
    // that differ by less than this tolerance.
    constexpr double kTolerance = 1e-9;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
    Eigen::VectorXd open = Eigen::VectorXd::Zero(scaled.cols());
    for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
        if (svd.singularValues()(k) > kTolerance * svd.singularValues()(0)) continue;
        open += svd.matrixV().col(k).cwiseAbs2();
    }
    std::vector<std::size_t> unknowns;
    for (Eigen::Index k = 0; k < open.size(); ++k)
        if (open(k) > kTolerance) unknowns.push_back(static_cast<std::size_t>(k));
    return unknowns;
}

/// Returns the groups of stations that no chain of stations and loops connects with a datum, as one
/// text of joined names per group; empty if there are none.
std::vector<std::string> unconnected_groups(const NetworkReadings& readings) {
    // The stations of a loop are connected, because they share its constant: merge their groups.
    std::vector<std::size_t> group(readings.stations.size());
    std::iota(group.begin(), group.end(), std::size_t(0));
    std::map<std::size_t, std::size_t> first_of_loop;
    for (std::size_t i = 0; i < readings.station_of.size(); ++i) {
        const std::size_t station = readings.station_of[i];
        const auto [first, is_new] = first_of_loop.emplace(readings.loop_of[i], station);
        if (is_new) continue;
        const std::size_t from = group[station], to = group[first->second];
        std::ranges::replace(group, from, to);
    }
    std::map<std::size_t, std::set<std::size_t>> members;
    for (std::size_t station = 0; station < group.size(); ++station)
        members[group[station]].insert(station);
    std::vector<std::string> groups;
    for (const auto& [id, stations] : members)
        if (!holds_datum(readings, stations)) groups.push_back(named(readings, stations));
    return groups;
}

/// Returns the groups of stations that only the instrument's constant and drift connect with a
/// datum, because no station is occupied both before and after.
std::vector<std::string> groups_tied_by_drift(const NetworkReadings& readings) {
    std::vector<std::string> groups;
    std::set<std::size_t> group;
    const auto& station_of = readings.station_of;
    for (auto reading = station_of.begin(); reading != station_of.end(); ++reading) {
        group.insert(*reading);
        // A group ends if none of its stations is occupied again later.
        if (std::any_of(reading + 1, station_of.end(),
                        [&](std::size_t station) { return group.contains(station); }))
            continue;
        if (!holds_datum(readings, group)) groups.push_back(named(readings, group));
        group.clear();
    }
    return groups;
}

/// Returns true if a station was read twice in one loop.
bool has_repeat(const NetworkReadings& readings) {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    for (std::size_t i = 0; i < readings.station_of.size(); ++i)
        if (!seen.emplace(readings.loop_of[i], readings.station_of[i]).second) return true;
    return false;
}

void solve(NetworkAdjustment& network, const NetworkSystem& system) {
    const Eigen::Index n = system.a.rows();
    Eigen::VectorXd weights(n);
    for (Eigen::Index i = 0; i < n; ++i)
        weights(i) = 1.0 / network.rows[static_cast<std::size_t>(i)].sd;
    // x = (A^T W A)^-1 A^T W y, by QR of the weighted rows with columns of length 1.
    Eigen::MatrixXd a = weights.asDiagonal() * system.a;
    const Eigen::VectorXd scale = a.colwise().norm().transpose().cwiseInverse();
    a = a * scale.asDiagonal();
    const linear_algebra::PivotedQr qr(a);
    const Eigen::Index p = a.cols();
    network.unknowns = scale.asDiagonal() * qr.solve(weights.asDiagonal() * system.y);
    // Q_xx = (A^T W A)^-1
    const Eigen::MatrixXd root = scale.asDiagonal() * qr.cofactor_root();
    network.covariance = root * root.transpose();

    // v = A x - y
    const Eigen::VectorXd residuals = system.a * network.unknowns - system.y;
    network.weighted_square = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
        NetworkRow& row = network.rows[static_cast<std::size_t>(i)];
        row.residual = residuals(i);
        // r_i = (Q_vv W)_ii = 1 - (A Q_xx A^T W)_ii: share of the row's variance in its residual
        // (Baarda 1968).
        row.redundancy = 1.0 - (system.a.row(i) * root).squaredNorm() * weights(i) * weights(i);
        network.weighted_square += std::pow(row.residual * weights(i), 2);
    }
    network.dof = static_cast<std::size_t>(n - p);
    if (network.dof > 0) {
        const boost::math::chi_squared distribution(static_cast<double>(network.dof));
        network.chi_square_low = boost::math::quantile(distribution, kGlobalTestAlpha);
        network.chi_square_high =
            boost::math::quantile(boost::math::complement(distribution, kGlobalTestAlpha));
    }
}

/// Returns a message that says why these unknowns are undetermined, and what would help.
Refusal refusal_of(const NetworkAdjustment& network, const NetworkReadings& readings,
                   const std::vector<std::size_t>& open) {
    std::vector<std::string> names;
    bool has_drift = false;
    for (const std::size_t k : open) {
        if (k < network.stations.size()) {
            names.push_back(network.stations[k]);
            continue;
        }
        const NetworkTerm& term = network.terms[k - network.stations.size()];
        names.push_back(term.name);
        has_drift = has_drift || term.kind == TermKind::drift;
    }
    return {fmt::format("the readings do not determine {}: {}", text::joined(names),
                        has_repeat(readings)
                            ? "there are fewer repeated readings than coefficients to determine"
                            : "every station is occupied only once in its loop"),
            has_drift ? "further occupations of a station at other times, more datum stations, a "
                        "prior on time_mgal_per_h, or a smaller drift_degree"
                      : "further occupations, more datum stations, or a prior on a coefficient"};
}

void add_remarks(NetworkAdjustment& network, const NetworkReadings& readings) {
    const std::vector<std::string> tied = groups_tied_by_drift(readings);
    if (!tied.empty())
        network.remarks.push_back(text::message(
            "connected with a datum only by the instrument's constant and drift, because no "
            "station is occupied before and after: {}",
            text::joined(tied, "; ")));
    // Datum rows are not checked: their redundancy is always small, because a wrong reference shows
    // in the residuals of the readings.
    std::vector<std::string> uncontrolled;
    for (std::size_t i = 0; i < network.reading_count; ++i) {
        const NetworkRow& row = network.rows[i];
        if (row.redundancy < kControlledRedundancy) uncontrolled.push_back(row.label);
    }
    if (!uncontrolled.empty())
        network.remarks.push_back(text::message(
            "practically uncontrolled (redundancy below 0.1), a blunder there cannot be found: {}",
            text::joined(uncontrolled)));
}

}  // namespace

std::optional<double> NetworkAdjustment::s0() const {
    if (dof == 0) return std::nullopt;
    return std::sqrt(weighted_square / static_cast<double>(dof));
}

std::optional<bool> NetworkAdjustment::passes_global_test() const {
    if (dof == 0) return std::nullopt;
    return weighted_square <= chi_square_high;
}

std::optional<double> NetworkAdjustment::studentised(std::size_t reading) const {
    const NetworkRow& row = rows[reading];
    if (dof < 2 || row.redundancy < kLeastRedundancy) return std::nullopt;
    // s_i^2 = (v^T W v - w_i v_i^2 / r_i) / (dof - 1)
    const double own = std::pow(row.residual / row.sd, 2) / row.redundancy;
    const double variance = (weighted_square - own) / static_cast<double>(dof - 1);
    if (!(variance > 0.0)) return std::nullopt;
    return row.residual / (row.sd * std::sqrt(variance * row.redundancy));
}

double NetworkAdjustment::effect_mgal(std::size_t row, std::size_t term) const {
    return term_columns(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(term)) *
           unknowns(static_cast<Eigen::Index>(stations.size() + term));
}

const NetworkRow* NetworkAdjustment::datum_of(std::string_view site) const {
    const auto row = std::ranges::find_if(
        rows, [&](const NetworkRow& one) { return one.held && stations[*one.held] == site; });
    return row == rows.end() ? nullptr : &*row;
}

NetworkResult adjust_network(const std::vector<reading::SurveyRow>& rows,
                             const std::vector<bool>& in_use, const std::vector<std::string>& datum,
                             const Priors& priors, const NetworkOptions& options) {
    const NetworkReadings readings = find_stations(rows, in_use, datum);
    for (std::size_t k = 0; k < readings.stations.size(); ++k) {
        const std::string& name = readings.stations[k];
        if (!readings.is_held[k] && std::ranges::find(datum, name) != datum.end())
            return {{},
                    {fmt::format("datum = {}: no reference gravity", name),
                     "stations with gravity_mgal"}};
    }
    if (readings.stations.empty()) return {{}, {"no reading in use", "at least one"}};
    if (std::ranges::count(readings.is_held, true) == 0)
        return {{},
                {"no datum: none of the stations in use has a reference that is held, so the "
                 "constant is undetermined",
                 fmt::format("gravity_mgal of at least one occupied station ({})",
                             text::joined(readings.stations))}};
    if (const auto groups = unconnected_groups(readings); !groups.empty())
        return {{},
                {fmt::format("unconnected: no chain of stations and loops joins a datum to {}",
                             text::joined(groups, "; ")),
                 "a datum in every group, or its rows taken out of use"}};
    NetworkAdjustment network;
    network.stations = readings.stations;
    set_terms(network, rows, in_use, priors, options);
    for (int round = 0; round < kScaleRounds; ++round) {
        const NetworkSystem system = build_system(network, rows, in_use, readings, priors, options);
        // A scale has a prior, so the rounds after the first determine the same unknowns.
        const std::vector<std::size_t> open =
            round == 0 ? undetermined_unknowns(system.a) : std::vector<std::size_t>();
        if (!open.empty()) return {{}, refusal_of(network, readings, open)};
        solve(network, system);
        if (round + 1 < kScaleRounds) set_scale_columns(network, rows);
    }
    add_remarks(network, readings);
    return {std::move(network), {}};
}

}  // namespace a351::corrector::model
