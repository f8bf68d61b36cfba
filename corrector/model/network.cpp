#include "corrector/model/network.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "corrector/model/network_diagnosis.hpp"
#include "corrector/model/network_system.hpp"
#include "protocol/linear_algebra/pivoted_qr.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

void solve(NetworkAdjustment& network, const NetworkSystem& system) {
    const Eigen::Index n = system.a.rows();
    Eigen::VectorXd weights(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        weights(i) = 1.0 / network.rows[static_cast<std::size_t>(i)].sd;
    }
    // x = (A^T W A)^-1 A^T W y, by QR of the weighted rows with columns of length 1.
    Eigen::MatrixXd a = weights.asDiagonal() * system.a;
    const Eigen::VectorXd scale = a.colwise().norm().transpose().cwiseInverse();
    a = a * scale.asDiagonal();
    const PivotedQr qr(a);
    const Eigen::Index p = a.cols();
    network.unknowns = scale.asDiagonal() * qr.solve(weights.asDiagonal() * system.y);
    // Q_xx = (A^T W A)^-1
    const Eigen::MatrixXd root = scale.asDiagonal() * qr.cofactor_root();
    network.covariance = root * root.transpose();

    // v = A x - y
    const Eigen::VectorXd residuals = system.a * network.unknowns - system.y;
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
        network.chi_square_low = boost::math::quantile(distribution, kGlobalTestAlpha / 2.0);
        network.chi_square_high =
            boost::math::quantile(boost::math::complement(distribution, kGlobalTestAlpha / 2.0));
    }
}

/// Returns a message that says why these unknowns are undetermined, and what would help.
std::string refusal_of(const NetworkAdjustment& network, const NetworkReadings& readings,
                       const std::vector<std::size_t>& open) {
    std::vector<std::string> names;
    bool has_drift = false;
    for (const std::size_t k : open) {
        const bool is_term = k >= network.stations.size();
        names.push_back(is_term ? network.terms[k - network.stations.size()] : network.stations[k]);
        has_drift = has_drift || (is_term && names.back().starts_with("time"));
    }
    std::string reason = "there are fewer repeated readings than coefficients to determine";
    if (!has_repeat(readings)) reason = "every station is occupied only once in its loop";
    return "the readings do not determine " + text::joined(names) + ": " + reason +
           (has_drift ? "; allowed: further occupations of a station at other times, more datum "
                        "stations, a prior on time_mgal_per_h, or a smaller drift_degree"
                      : "; allowed: further occupations, more datum stations, or a prior on a "
                        "coefficient");
}

void add_remarks(NetworkAdjustment& network, const NetworkReadings& readings) {
    const std::string tied = groups_tied_by_drift(readings);
    if (!tied.empty()) {
        network.remarks.push_back(
            "connected with a datum only by the instrument's constant and drift, because no "
            "station is occupied before and after: " +
            tied);
    }
    // Datum rows are not checked: their redundancy is always small, because a wrong reference shows
    // in the residuals of the readings.
    std::vector<std::string> uncontrolled;
    for (std::size_t i = 0; i < network.reading_count; ++i) {
        const NetworkRow& row = network.rows[i];
        if (row.redundancy < kControlledRedundancy) uncontrolled.push_back(row.label);
    }
    if (!uncontrolled.empty()) {
        network.remarks.push_back(
            "practically uncontrolled (redundancy below 0.1), a blunder there cannot be found: " +
            text::joined(uncontrolled));
    }
}

}  // namespace

std::optional<double> NetworkAdjustment::s0() const {
    if (dof == 0) return std::nullopt;
    return std::sqrt(weighted_square / static_cast<double>(dof));
}

std::optional<bool> NetworkAdjustment::passes_global_test() const {
    if (dof == 0) return std::nullopt;
    return weighted_square >= chi_square_low && weighted_square <= chi_square_high;
}

std::optional<double> NetworkAdjustment::studentised(std::size_t reading) const {
    const NetworkRow& row = rows[reading];
    // An uncontrolled row has redundancy 0 except for rounding.
    if (dof < 2 || row.redundancy < 1e-9) return std::nullopt;
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

NetworkResult adjust_network(const std::vector<SurveyRow>& rows, const std::vector<bool>& in_use,
                             const std::vector<std::string>& datum, const ModelPriors& priors,
                             const NetworkOptions& options) {
    const Occupied occupied = find_stations(rows, in_use, datum);
    const NetworkReadings& readings = occupied.readings;
    for (std::size_t k = 0; k < readings.stations.size(); ++k) {
        const std::string& name = readings.stations[k];
        const bool is_listed = std::find(datum.begin(), datum.end(), name) != datum.end();
        if (!is_listed || readings.is_held[k]) continue;
        return {{},
                "datum = " + name + ": no reference gravity; allowed: stations with gravity_mgal"};
    }
    if (readings.stations.empty()) return {{}, "no reading in use; allowed: at least one"};
    if (std::count(readings.is_held.begin(), readings.is_held.end(), true) == 0) {
        return {
            {},
            "no datum: none of the stations in use has a reference that is held, so the "
            "constant is undetermined; allowed: gravity_mgal of at least one occupied station (" +
                text::joined(readings.stations) + ")"};
    }
    if (const auto groups = unconnected_groups(readings); !groups.empty()) {
        return {{},
                "unconnected: no chain of stations and loops joins a datum to " +
                    text::joined(groups, "; ") +
                    "; allowed: a datum in every group, or its rows taken out of use"};
    }
    NetworkAdjustment network;
    network.stations = readings.stations;
    set_terms(network, rows, in_use, priors, options.drift_degree);
    const NetworkSystem system = build_system(network, rows, in_use, occupied, priors, options);
    const std::vector<std::size_t> open = undetermined_unknowns(system.a);
    if (!open.empty()) return {{}, refusal_of(network, readings, open)};
    solve(network, system);
    add_remarks(network, readings);
    return {std::move(network), {}};
}

}  // namespace a351::corrector
