#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/model.hpp"
#include "corrector/model/network_system.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

Score score_of(const NetworkAdjustment& network, double reading_sd_mgal) {
    Score score;
    score.model = kNetwork;
    score.row_count = network.reading_count;
    score.parameter_count = static_cast<std::size_t>(network.unknowns.size());
    score.dof = network.dof;
    double squares = 0.0;
    for (std::size_t i = 0; i < network.reading_count; ++i)
        squares += network.rows[i].residual * network.rows[i].residual;
    score.rms_mgal = std::sqrt(squares / static_cast<double>(network.reading_count));
    if (const auto s0 = network.s0()) score.s_mgal = *s0 * reading_sd_mgal;
    if (network.datum_count < 2) return score;
    // Residual / redundancy is the error of predicting a datum without its own row.
    squares = 0.0;
    for (std::size_t k = 0; k < network.datum_count; ++k) {
        const NetworkRow& datum = network.rows[network.reading_count + k];
        if (datum.redundancy < kLeastRedundancy) return score;
        squares += std::pow(datum.residual / datum.redundancy, 2);
    }
    score.loso_mgal = std::sqrt(squares / static_cast<double>(network.datum_count));
    return score;
}

/// Sums of the effects of a network's terms on a row, one sum for each correction, mGal.
struct Effects {
    double constant = 0.0, drift = 0.0, temperature = 0.0, rate = 0.0, pressure = 0.0, scale = 0.0;

    double& of(TermKind kind) {
        switch (kind) {
            case TermKind::constant:
                return constant;
            case TermKind::drift:
            case TermKind::step:
                return drift;
            case TermKind::temperature:
                return temperature;
            case TermKind::rate:
                return rate;
            case TermKind::admittance:
                return pressure;
            case TermKind::scale:
                return scale;
        }
        return constant;
    }
};

/// Returns the variance (mGal^2 a priori) of the terms' effect on a row, or on a mean of rows.
/// @param line  the row's regressors, or their mean.
double effect_variance(const NetworkAdjustment& network, const Eigen::RowVectorXd& line) {
    const Eigen::Index k = line.size();
    return (line * network.covariance.bottomRightCorner(k, k)).dot(line);
}

void set_rows(Fit& result, const NetworkAdjustment& network, const std::vector<bool>& in_use,
              const Priors& priors) {
    std::size_t reading = 0;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        out.is_used = in_use[i];
        Effects effects;
        for (std::size_t k = 0; k < network.terms.size(); ++k)
            effects.of(network.terms[k].kind) += network.effect_mgal(i, k);
        out.temperature_correction = MilliGal(-effects.constant - effects.temperature);
        out.rate_correction = MilliGal(-effects.rate);
        out.drift_correction = MilliGal(-effects.drift);
        out.scale_correction = MilliGal(-effects.scale);
        if (out.row.pressure_correction) {
            const MilliGal pressure(effects.pressure);
            out.row.acceleration = out.row.acceleration - pressure;
            *out.row.pressure_correction = *out.row.pressure_correction - pressure;
        }
        out.corrected = out.row.acceleration - out.row.tide + out.temperature_correction +
                        out.rate_correction + out.drift_correction + *out.scale_correction;
        if (out.row.reference) out.residual = *out.row.reference - out.corrected;
        const double sd = sd_mgal_of(out.row, priors);
        const double variance =
            effect_variance(network, network.term_columns.row(static_cast<Eigen::Index>(i)));
        out.u_corrected = MilliGal(std::sqrt(sd * sd + variance));
        out.leverage = variance / (sd * sd);
        if (!in_use[i]) continue;
        out.leverage = 1.0 - network.rows[reading].redundancy;
        out.studentised_residual = network.studentised(reading++);
    }
}

/// Correlation of the pressure with the readings, over the rows in use.
double pressure_correlation(const std::vector<CorrectedRow>& rows,
                            const std::vector<bool>& in_use) {
    double n = 0.0, p = 0.0, g = 0.0, pp = 0.0, gg = 0.0, pg = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const reading::SurveyRow& row = rows[i].row;
        if (!in_use[i] || !row.pressure_hpa) continue;
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

/// Returns the fitted admittance in words, and if the readings can distinguish it from gravity.
text::Message admittance_remark(const Fit& result, const NetworkAdjustment& network,
                                const std::vector<bool>& in_use) {
    // Real admittances are -0.0002 to -0.0004 mGal/hPa: a value whose error is larger than half
    // this range is not better than the usual one.
    constexpr double kUsual_mgal_per_hpa = -0.0003, kGoodError_mgal_per_hpa = 0.0001;
    const auto term = std::ranges::find(network.terms, TermKind::admittance, &NetworkTerm::kind) -
                      network.terms.begin();
    const Coefficient& admittance = result.coefficients[static_cast<std::size_t>(term)];
    const double u = admittance.standard_error.value();
    return text::message(
        "admittance {:.5f} +- {:.5f} mGal/hPa, fitted; pressure and readings correlate by {:.3f}{}",
        admittance.value, u, pressure_correlation(result.rows, in_use),
        u <= kGoodError_mgal_per_hpa
            ? text::Message()
            : text::message(": it cannot be distinguished from gravity and drift, use the fixed {}",
                            kUsual_mgal_per_hpa));
}

StationValue adjusted_station(const Fit& result, const NetworkAdjustment& network, std::size_t k) {
    const auto at = static_cast<Eigen::Index>(k);
    StationValue station;
    station.site = network.stations[k];
    station.gravity = network.origin + MilliGal(network.unknowns(at));
    station.u_gravity = MilliGal(std::sqrt(network.covariance(at, at)));
    if (const auto s0 = network.s0())
        station.u_a_posteriori = MilliGal(*s0 * station.u_gravity->value());
    station.redundancy = 0.0;
    for (const CorrectedRow& row : result.rows) {
        if (row.row.site != station.site) continue;
        station.reference = row.row.reference;
        if (!row.is_used) continue;
        ++station.row_count;
        *station.redundancy += 1.0 - row.leverage.value();
    }
    if (const NetworkRow* const datum = network.datum_of(station.site))
        *station.redundancy += datum->redundancy;
    return station;
}

/// Returns the value of a station that occurs in flagged rows only.
StationValue flagged_station(const Fit& result, const NetworkAdjustment& network, double sd,
                             const std::string& site) {
    StationValue station;
    station.site = site;
    station.is_flagged_only = true;
    double sum = 0.0;
    Eigen::RowVectorXd line = Eigen::RowVectorXd::Zero(network.term_columns.cols());
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const CorrectedRow& row = result.rows[i];
        if (row.row.site != site || !network.is_tied[i]) continue;
        station.reference = row.row.reference;
        ++station.row_count;
        sum += (row.corrected - network.origin).value();
        line += network.term_columns.row(static_cast<Eigen::Index>(i));
    }
    const auto n = static_cast<double>(station.row_count);
    station.gravity = network.origin + MilliGal(sum / n);
    station.u_gravity = MilliGal(std::sqrt(sd * sd / n + effect_variance(network, line / n)));
    return station;
}

/// Moves rows whose loop has no constant to left_out, with a remark.
void leave_out_untied(Fit& result, const NetworkAdjustment& network) {
    std::vector<CorrectedRow> rows;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        if (network.is_tied[i]) {
            rows.push_back(std::move(result.rows[i]));
            continue;
        }
        names.push_back(fmt::format("{} ({})", row.site, row.occupation));
        result.left_out.push_back({row.site, row.occupation, row.start.value_or(row.time),
                                   row.end.value_or(row.time), "no reading of its loop in use"});
    }
    result.rows = std::move(rows);
    if (names.empty()) return;
    result.remarks.push_back(
        text::message("no reading in use between two pauses of more than {} h, so the instrument's "
                      "constant is undetermined there: left out are {}",
                      std::lround(kLoopPause_h), text::joined(names)));
}

void set_stations(Fit& result, const NetworkAdjustment& network, double sd) {
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const std::string& site = result.rows[i].row.site;
        if (!network.is_tied[i] ||
            std::ranges::find(result.stations, site, &StationValue::site) != result.stations.end())
            continue;
        const auto at = std::ranges::find(network.stations, site);
        result.stations.push_back(
            at == network.stations.end()
                ? flagged_station(result, network, sd, site)
                : adjusted_station(result, network,
                                   static_cast<std::size_t>(at - network.stations.begin())));
        StationValue& station = result.stations.back();
        if (station.reference) station.residual = *station.reference - station.gravity;
    }
}

/// Sets the values without the own datum, the covariance and the differences of all stations in the
/// network.
void set_station_errors(Fit& result, const NetworkAdjustment& network) {
    StationCovariance covariance;
    std::vector<Eigen::Index> places;
    for (StationValue& station : result.stations) {
        if (network.passes_global_test().value_or(true)) {
            station.coverage_factor = kCoverageFactor;
            station.dof = static_cast<double>(network.dof);
        }
        const auto at = std::ranges::find(network.stations, station.site);
        if (at == network.stations.end()) continue;
        covariance.sites.push_back(station.site);
        places.push_back(at - network.stations.begin());
        station.left_out = station.gravity;
        station.u_left_out = station.u_gravity;
        const NetworkRow* const datum = network.datum_of(station.site);
        if (datum == nullptr) continue;
        // The prediction without the row: reference + v / r, with the variance sd^2 (1 - r) / r.
        station.left_out.reset();
        station.u_left_out.reset();
        if (datum->redundancy < kLeastRedundancy) continue;
        station.left_out = *station.reference + MilliGal(datum->residual / datum->redundancy);
        station.u_left_out =
            MilliGal(datum->sd * std::sqrt((1.0 - datum->redundancy) / datum->redundancy));
    }
    covariance.mgal2 = network.covariance(places, places);
    for (std::size_t b = 0; b < covariance.sites.size(); ++b) {
        const StationValue& to =
            *std::ranges::find(result.stations, covariance.sites[b], &StationValue::site);
        for (std::size_t a = 0; a < b; ++a) {
            const StationValue& from =
                *std::ranges::find(result.stations, covariance.sites[a], &StationValue::site);
            const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
            const Eigen::MatrixXd& c = covariance.mgal2;
            result.differences.push_back(
                difference_of(from, to, to.gravity - from.gravity,
                              MilliGal(std::sqrt(c(i, i) + c(k, k) - 2.0 * c(i, k)))));
        }
    }
    result.covariance = std::move(covariance);
}

NetworkResult adjust(const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& in_use,
                     const SurveyOptions& options) {
    NetworkOptions network = options.network;
    network.steps = options.steps;
    return adjust_network(rows, in_use, options.datum, options.priors, network);
}

FitResult fit_network(const SurveyProblem& problem, const RowChoice& choice) {
    const SurveyOptions& options = problem.options;
    const double sd = options.priors.reading_sd_mgal;
    NetworkResult adjusted = adjust(problem.rows, choice.accepted, options);
    if (!adjusted.adjustment) return std::move(adjusted.refusal);
    const NetworkAdjustment& network = *adjusted.adjustment;
    Fit result;
    result.rows = uncorrected(problem, choice);
    result.score = score_of(network, sd);
    for (std::size_t k = 0; k < network.terms.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(network.stations.size() + k);
        result.coefficients.push_back({network.terms[k].name, network.unknowns(at),
                                       std::sqrt(network.covariance(at, at)),
                                       network.terms[k].prior});
    }
    for (const NetworkScale& scale : network.scales) {
        Coefficient& coefficient = result.coefficients[scale.term];
        coefficient.value += 1.0;
        coefficient.prior = scale.prior;
        result.scales.push_back(
            {scale.instrument, coefficient.value, coefficient.standard_error.value(), scale.prior});
    }
    set_rows(result, network, choice.accepted, options.priors);
    if (options.network.fits_admittance)
        result.remarks.push_back(admittance_remark(result, network, choice.accepted));
    set_stations(result, network, sd);
    set_station_errors(result, network);
    leave_out_untied(result, network);
    result.remarks.insert(result.remarks.end(), network.remarks.begin(), network.remarks.end());
    result.own = std::move(*adjusted.adjustment);
    return result;
}

Score score_network(const SurveyProblem& problem, const RowChoice& choice) {
    const NetworkResult adjusted = adjust(problem.rows, choice.accepted, problem.options);
    if (adjusted.adjustment)
        return score_of(*adjusted.adjustment, problem.options.priors.reading_sd_mgal);
    Score none;
    none.model = kNetwork;
    return none;
}

std::optional<NetworkAdjustment> adjusted(const ChosenSurvey& survey) {
    return adjust(survey.problem.rows, survey.choice.accepted, survey.problem.options).adjustment;
}

std::optional<Noise> network_noise(const ChosenSurvey& survey, const Noise* /*nearby*/) {
    const auto network = adjusted(survey);
    if (!network || !network->s0() || !(*network->s0() > 0.0)) return std::nullopt;
    NetworkNoise noise{*network->s0(), {}, network->origin};
    for (std::size_t k = 0; k < network->stations.size(); ++k)
        noise.above_origin_mgal[network->stations[k]] =
            network->unknowns(static_cast<Eigen::Index>(k));
    return noise;
}

std::optional<residual::Residuals> network_residuals(const ChosenSurvey& survey,
                                                     const Noise& noise) {
    auto network = adjusted(survey);
    if (!network) return std::nullopt;
    const SurveyOptions& options = survey.problem.options;
    // A mistake can move gravities and scales far away.  The system is therefore linearised at the
    // gravities without the mistakes, and at the means of the priors.
    const auto& of_network = std::get<NetworkNoise>(noise);
    for (std::size_t k = 0; k < network->stations.size(); ++k)
        if (const auto known = of_network.above_origin_mgal.find(network->stations[k]);
            known != of_network.above_origin_mgal.end())
            network->unknowns(static_cast<Eigen::Index>(k)) =
                known->second + (of_network.origin - network->origin).value();
    for (const NetworkScale& scale : network->scales)
        network->unknowns(static_cast<Eigen::Index>(network->stations.size() + scale.term)) =
            scale.prior.mean - 1.0;
    set_scale_columns(*network, survey.problem.rows);
    const std::vector<reading::SurveyRow>& rows = survey.problem.rows;
    const NetworkSystem system =
        build_system(*network, rows, survey.choice.accepted,
                     find_stations(rows, survey.choice.accepted, options.datum), options.priors,
                     options.network);
    std::vector<std::size_t> readings;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (survey.choice.accepted[i]) readings.push_back(i);
    readings.resize(network->rows.size(), rows.size());
    Eigen::VectorXd weights(system.y.size());
    // The noise is that of the readings: datum and priors keep their standard deviations.
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        weights(i) = 1.0 / ((at < network->reading_count ? of_network.s0 : 1.0) *
                            network->rows[at].sd);
    }
    return residual::residuals_of(weights.asDiagonal() * system.a, weights.asDiagonal() * system.y,
                                  readings, weights, rows.size());
}

}  // namespace

Model network_model() {
    return {kNetwork, false, fit_network, score_network, network_noise, network_residuals};
}

}  // namespace a351::corrector::model
