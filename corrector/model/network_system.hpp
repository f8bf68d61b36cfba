#pragma once
/// @file
/// The linear system of a network: who was where, the instrument's terms, the rows.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "corrector/model/network.hpp"
#include "corrector/model/network_diagnosis.hpp"

namespace a351::corrector {

struct Occupied {
    NetworkReadings readings;
    std::vector<MilliGal> references;  ///< Of the stations; 0 where there is none.
};

/// @param in_use, datum  as of adjust_network().
[[nodiscard]] Occupied find_stations(const std::vector<SurveyRow>& rows,
                                     const std::vector<bool>& in_use,
                                     const std::vector<std::string>& datum);

/// Sets the terms of the instrument, their columns for all rows, and which rows are tied to them.  A temperature that does not
/// vary and has no prior is left out, with a remark.
void set_terms(NetworkAdjustment& network, const std::vector<SurveyRow>& rows,
               const std::vector<bool>& in_use, const ModelPriors& priors, int drift_degree);

/// A x = y.  Labels and standard deviations of its rows are those of NetworkAdjustment::rows.
struct NetworkSystem {
    Eigen::MatrixXd a;
    Eigen::VectorXd y;
};

/// The rows of readings in use, datum and priors; sets origin, rows and their counts as well.
[[nodiscard]] NetworkSystem build_system(NetworkAdjustment& network,
                                         const std::vector<SurveyRow>& rows,
                                         const std::vector<bool>& in_use, const Occupied& occupied,
                                         const ModelPriors& priors, const NetworkOptions& options);

}  // namespace a351::corrector
