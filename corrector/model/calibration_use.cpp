#include "corrector/model/calibration_use.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/model/model.hpp"
#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<Eigen::Index> kAxisPlaces{whole_day::DayPriors::place_of(whole_day::DayTerm::x),
                                            whole_day::DayPriors::place_of(whole_day::DayTerm::y)};
// In the order of kThermalNames: rA, rS, rF, then the lags, which are first in DayPriors.
const std::vector<Eigen::Index> kThermalPlaces{
    whole_day::DayPriors::place_of(whole_day::DayTerm::level),
    whole_day::DayPriors::place_of(whole_day::DayTerm::slow),
    whole_day::DayPriors::place_of(whole_day::DayTerm::fast), 0, 1};

MilliGal tilt_effect(const reading::SurveyRow& row, const std::optional<unit::AxisBias>& bias) {
    if (!bias) return MilliGal(0.0);
    return MilliGal(bias->values(0) * row.axes_for("calibration").x.mean.value() +
                    bias->values(1) * row.axes_for("calibration").y.mean.value());
}

bool is_contradicted(const std::optional<Disagreement>& test) {
    return test && test->p < kContradictionP;
}

bool is_harmful(const CalibrationUse& use, const Score& score) {
    return use.loso_without_mgal && score.loso_mgal &&
           *score.loso_mgal > (1.0 + kHarm) * *use.loso_without_mgal;
}

text::Message name_of(const unit::Calibration& calibration) {
    return text::message("calibration of unit {} ({}, from {})", calibration.serial_number,
                         calibration.program, to_rfc3339(calibration.valid_from));
}

void remark_test(Fit& result, const text::Message& part, const std::optional<Disagreement>& test) {
    if (!test)
        result.remarks.push_back(text::message(
            "the calibration's {} not tested: the readings contain no information about this part",
            part));
    if (is_contradicted(test))
        result.remarks.push_back(text::message(
            "the readings contradict the calibration's {}: chi-square {} for {} degrees of "
            "freedom, by chance less than once in a hundred surveys; check that it belongs to this "
            "unit and is still valid, and correct the survey without it too",
            part, text::fixed(test->chi_square, 1), test->dof));
}

Json part_json(bool is_there, const char* use, const std::optional<Disagreement>& test) {
    if (!is_there) return nullptr;
    return {{"use", use},
            {"chi_square", test ? Json(test->chi_square) : Json(nullptr)},
            {"dof", test ? Json(test->dof) : Json(nullptr)},
            {"p", test ? Json(test->p) : Json(nullptr)},
            {"contradicted", test ? Json(is_contradicted(test)) : Json(nullptr)}};
}

}  // namespace

bool helps_to_correct_day(const std::optional<unit::Calibration>& calibration) {
    return calibration && (calibration->axis_bias || calibration->thermal ||
                           calibration->placement || calibration->scale || calibration->faces);
}

whole_day::DayPriors day_priors_of(const SurveyOptions& options) {
    whole_day::DayPriors priors = day_priors_of(options.calibration);
    if (const adjustment::Prior* const scale = options.priors.find(adjustment::kScale))
        priors.set_scale(scale->mean, scale->sd);
    for (std::size_t k = 0; k < whole_day::kDayTerms; ++k)
        if (const auto factor = options.priors.factors.find(whole_day::kDayTermList.at(k)->name);
            factor != options.priors.factors.end())
            priors.factor.row(whole_day::DayPriors::place_of(static_cast<whole_day::DayTerm>(k))) *=
                factor->second;
    return priors;
}

whole_day::DayPriors day_priors_of(const std::optional<unit::Calibration>& calibration) {
    whole_day::DayPriors priors = whole_day::usual_day_priors();
    if (!calibration) return priors;
    if (const auto& bias = calibration->axis_bias) {
        priors.free_axes();
        priors.observe(kAxisPlaces, bias->values, bias->covariance);
    }
    if (const auto& thermal = calibration->thermal)
        priors.observe(kThermalPlaces, thermal->values,
                       unit::kThermalErrorFactor * unit::kThermalErrorFactor * thermal->covariance);
    if (const auto& placement = calibration->placement)
        priors.placement_mgal = {placement->mgal, std::exp(placement->log_error())};
    if (const auto& scale = calibration->scale)
        priors.set_scale(scale->value, scale->standard_error);
    if (calibration->faces) priors.scale_share = unit::scale_share_of(*calibration->faces);
    return priors;
}

// If the prior is true, the shift (the posterior mean) scatters about 0 with the covariance
// D = 1 - posterior covariance.  In directions in which D is 0 the day contains no information.
std::optional<Disagreement> disagreement(const whole_day::DayFit& fit,
                                         const std::vector<Eigen::Index>& places) {
    // Least D of a direction that is tested.  A tight and wrong prior makes D small, because the
    // noise takes the disagreement.  Terms are solved for: their limit is rounding.  Lags are
    // searched for to 1e-3 deviations: their limit is ten times that, squared.
    constexpr double kLeastOfTerm = 1e-10, kLeastOfLag = 1e-4;
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::VectorXd scale(count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const bool is_lag = places[static_cast<std::size_t>(k)] < Eigen::Index{whole_day::kDayLags};
        scale(k) = 1.0 / std::sqrt(is_lag ? kLeastOfLag : kLeastOfTerm);
    }
    const Eigen::MatrixXd gained = Eigen::MatrixXd::Identity(count, count) -
                                   Eigen::MatrixXd(fit.shift_covariance(places, places));
    const linear_algebra::SymmetricEigen axes =
        linear_algebra::symmetric_eigen(scale.asDiagonal() * gained * scale.asDiagonal());
    const Eigen::VectorXd along =
        axes.vectors.transpose() * scale.cwiseProduct(Eigen::VectorXd(fit.shift(places)));
    Disagreement test;
    for (Eigen::Index k = 0; k < count; ++k) {
        if (axes.values(k) < 1.0) continue;
        // chi-square = s^T D^-1 s
        test.chi_square += along(k) * along(k) / axes.values(k);
        ++test.dof;
    }
    if (test.dof == 0) return std::nullopt;
    test.p = signal::chi_square_exceedance(static_cast<double>(test.dof), test.chi_square);
    return test;
}

void report_prior_use(Fit& result, const unit::Calibration& calibration,
                      const whole_day::DayFit& fit, const whole_day::DayFit& without,
                      const std::optional<double>& without_loso_mgal) {
    CalibrationUse use;
    use.is_prior = true;
    if (calibration.axis_bias) use.axis_bias = disagreement(fit, kAxisPlaces);
    if (calibration.thermal) use.thermal = disagreement(fit, kThermalPlaces);
    double squares = 0.0;
    for (std::size_t i = 0; i < fit.set_ups.size(); ++i)
        squares += std::pow((fit.set_ups[i].corrected - without.set_ups[i].corrected).value(), 2);
    use.effect_rms_mgal = std::sqrt(squares / static_cast<double>(fit.set_ups.size()));
    const unit::ScaleShare share = calibration.faces && !fit.on_scale.empty()
                                       ? unit::scale_share_of(*calibration.faces)
                                       : unit::ScaleShare{};
    result.remarks.push_back(text::message(
        "{} as prior: {}{}{}{}{}; it changes the corrected values by {} mGal rms{}",
        name_of(calibration),
        calibration.axis_bias ? text::message("axis biases") : text::message("no axis biases"),
        calibration.thermal ? text::message(", thermal response with its errors doubled")
                            : text::message(", no thermal response"),
        calibration.placement
            ? text::message(", placement {} mGal", text::fixed(calibration.placement->mgal, 2))
            : text::Message(),
        calibration.scale
            ? text::message(", scale {} +- {}", text::fixed(calibration.scale->value, 5),
                            text::fixed(calibration.scale->standard_error, 5))
            : text::Message(),
        share.is_measured
            ? text::message(", share of the scale in the response {} +- {}",
                            text::fixed(share.mean, 2), text::fixed(share.deviation, 2))
            : text::Message(),
        text::fixed(use.effect_rms_mgal, 2),
        calibration.axis_bias
            ? text::message(
                  "; for the scores of other models axis bias x tilt was subtracted from the "
                  "readings")
            : text::Message()));
    if (calibration.axis_bias) remark_test(result, text::message("axis biases"), use.axis_bias);
    if (calibration.thermal) remark_test(result, text::message("thermal response"), use.thermal);
    use.loso_without_mgal = without_loso_mgal;
    if (is_harmful(use, result.score))
        result.remarks.push_back(text::message(
            "with the calibration the survey is worse: stations left out are predicted with an "
            "error of {} mGal rms, without it {}; check that it belongs to this unit and is still "
            "valid",
            text::fixed(*result.score.loso_mgal, 2), text::fixed(*without_loso_mgal, 2)));
    result.calibration = use;
}

std::vector<reading::SurveyRow> without_known_tilt(
    std::vector<reading::SurveyRow> rows, const std::optional<unit::Calibration>& calibration) {
    if (calibration)
        for (reading::SurveyRow& row : rows)
            row.acceleration = row.acceleration - tilt_effect(row, calibration->axis_bias);
    return rows;
}

SurveyCorrection correct_with_calibration(const std::vector<reading::SurveyRow>& rows,
                                          const SurveyOptions& options,
                                          const reading::DayRecord* day) {
    if (!options.calibration) return correct_survey(rows, options, day);
    const unit::Calibration& calibration = *options.calibration;
    SurveyOptions with_scale = options;
    if (calibration.scale && options.priors.find(adjustment::kScale) == nullptr)
        adjustment::set_prior(with_scale.priors, "calibration", adjustment::kScale,
                              {calibration.scale->value, calibration.scale->standard_error});
    SurveyCorrection result =
        correct_survey(without_known_tilt(rows, options.calibration), with_scale, day);
    if (result.as<WholeDayPart>() != nullptr) return result;

    CalibrationUse use;
    double sum = 0.0, squares = 0.0;
    for (CorrectedRow& row : result.rows) {
        const MilliGal effect = tilt_effect(row.row, calibration.axis_bias);
        row.row.acceleration = row.row.acceleration + effect;
        if (row.difference) row.difference = *row.difference + effect;
        row.tilt_correction = row.tilt_correction_or_zero() - effect;
        sum += effect.value();
        squares += effect.value() * effect.value();
    }
    const auto n = static_cast<double>(result.rows.size());
    use.effect_rms_mgal = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
    text::Message text = name_of(calibration);
    if (calibration.axis_bias)
        text += text::message(
            ": axis bias x tilt was subtracted from the readings, for the scores of all models "
            "too; this correction varies by {} mGal rms from reading to reading; the calibration "
            "was not compared with the readings",
            text::fixed(use.effect_rms_mgal, 2));
    else
        text += text::message(": no axis biases");
    if (calibration.thermal)
        text += text::message("; its thermal response is not used by the model {}", result.model);
    result.remarks.push_back(text);
    result.calibration = use;
    return result;
}

std::string_view calibration_in(const SurveyCorrection& result, const Score& score) {
    const std::optional<unit::Calibration>& calibration = result.options.calibration;
    if (!helps_to_correct_day(calibration)) return "none";
    if (score.model == kWholeDay) return "prior";
    return calibration->axis_bias ? "fixed" : "none";
}

Json calibration_json(const SurveyCorrection& result) {
    if (!result.calibration) return nullptr;
    const unit::Calibration& calibration = result.options.calibration.value();
    const CalibrationUse& use = *result.calibration;
    const auto& valid_to = calibration.valid_to;
    const bool is_compared = use.loso_without_mgal.has_value();
    return {{"serial_number", calibration.serial_number},
            {"program", calibration.program},
            {"valid_from_utc", to_rfc3339(calibration.valid_from, 3)},
            {"valid_to_utc", valid_to ? Json(to_rfc3339(*valid_to, 3)) : Json(nullptr)},
            {"axis_bias", part_json(calibration.axis_bias.has_value(),
                                    use.is_prior ? "prior" : "fixed", use.axis_bias)},
            {"thermal", part_json(calibration.thermal.has_value(), use.is_prior ? "prior" : "none",
                                  use.thermal)},
            {"placement", part_json(calibration.placement.has_value(),
                                    use.is_prior ? "prior" : "none", std::nullopt)},
            {"scale", part_json(calibration.scale.has_value(),
                                result.scales.empty() ? "none" : "prior", std::nullopt)},
            {"effect_rms_mgal", use.effect_rms_mgal},
            {"loso_without_mgal", is_compared ? Json(*use.loso_without_mgal) : Json(nullptr)},
            {"worse_with_it", is_compared ? Json(is_harmful(use, result.score)) : Json(nullptr)}};
}

}  // namespace a351::corrector::model
