#include "corrector/model/network_diagnosis.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace a351::corrector {
namespace {

std::string named(const NetworkReadings& readings, const std::set<std::size_t>& stations) {
    std::string names;
    for (const std::size_t station : stations) {
        names += (names.empty() ? "" : ", ") + readings.stations[station];
    }
    return names;
}

bool holds_datum(const NetworkReadings& readings, const std::set<std::size_t>& stations) {
    return std::any_of(stations.begin(), stations.end(),
                       [&](std::size_t station) { return readings.is_held[station]; });
}

}  // namespace

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
    for (Eigen::Index k = 0; k < open.size(); ++k) {
        if (open(k) > kTolerance) unknowns.push_back(static_cast<std::size_t>(k));
    }
    return unknowns;
}

std::vector<std::string> unconnected_groups(const NetworkReadings& readings) {
    // The stations of a loop are connected, because they share its constant: merge their groups.
    std::vector<std::size_t> group(readings.stations.size());
    std::iota(group.begin(), group.end(), std::size_t(0));
    std::map<std::size_t, std::size_t> first_of_loop;
    for (std::size_t i = 0; i < readings.station_of.size(); ++i) {
        const std::size_t station = readings.station_of[i];
        const auto [first, is_new] = first_of_loop.emplace(readings.loop_of[i], station);
        if (is_new) continue;
        const std::size_t from = group[station];
        const std::size_t to = group[first->second];
        std::replace(group.begin(), group.end(), from, to);
    }
    std::map<std::size_t, std::set<std::size_t>> members;
    for (std::size_t station = 0; station < group.size(); ++station) {
        members[group[station]].insert(station);
    }
    std::vector<std::string> groups;
    for (const auto& [id, stations] : members) {
        if (!holds_datum(readings, stations)) groups.push_back(named(readings, stations));
    }
    return groups;
}

std::string groups_tied_by_drift(const NetworkReadings& readings) {
    std::string groups;
    std::set<std::size_t> group;
    const std::size_t n = readings.station_of.size();
    for (std::size_t i = 0; i < n; ++i) {
        group.insert(readings.station_of[i]);
        // A group ends if none of its stations is occupied again later.
        const bool comes_again =
            std::any_of(readings.station_of.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        readings.station_of.end(),
                        [&](std::size_t station) { return group.contains(station); });
        if (comes_again) continue;
        if (!holds_datum(readings, group)) {
            groups += (groups.empty() ? "" : "; ") + named(readings, group);
        }
        group.clear();
    }
    return groups;
}

bool has_repeat(const NetworkReadings& readings) {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    for (std::size_t i = 0; i < readings.station_of.size(); ++i) {
        if (!seen.emplace(readings.loop_of[i], readings.station_of[i]).second) return true;
    }
    return false;
}

}  // namespace a351::corrector
