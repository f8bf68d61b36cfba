#include "corrector/design/planned_unit.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "corrector/model/calibration_use.hpp"
#include "corrector/model/model.hpp"
#include "corrector/whole_day/unit_posterior.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::design {
namespace {

using nlohmann::json;

/// Returns the root of the mean square of `step` over neighbours; `usual` without neighbours.
template <class Step>
double rms_of_neighbours(const json& rows, double usual, Step step) {
    double squares = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i)
        squares += std::pow(step(rows[i - 1], rows[i]), 2);
    return rows.size() < 2 ? usual : std::sqrt(squares / static_cast<double>(rows.size() - 1));
}

double walk_of(const json& occupations) {
    return rms_of_neighbours(
        occupations, kUsualWalk_degc_per_sqrt_h, [](const json& before, const json& after) {
            const auto time = [](const json& row) {
                return parse_rfc3339(row.at("time_utc").get<std::string>()).value();
            };
            const double change = after.at("temperature_degc").get<double>() -
                                  before.at("temperature_degc").get<double>();
            const double later_s = seconds_between(time(before), time(after));
            if (!(later_s > 0.0)) throw std::invalid_argument("occupations: not in order of time");
            return change / std::sqrt(later_s / kSecondsPerHour);
        });
}

double tilt_of(const json& occupations) {
    return rms_of_neighbours(occupations, kUsualTilt_g, [](const json& before, const json& after) {
        const auto step = [&](const char* key) {
            return after.at(key).get<double>() - before.at(key).get<double>();
        };
        // Both axes and both set-ups have this scatter.
        return std::hypot(step("mean_x_g"), step("mean_y_g")) / 2.0;
    });
}

whole_day::UnitPosterior posterior_of(const json& found) {
    whole_day::UnitPosterior unit;
    const json& values = found.at("values");
    const json& covariance = found.at("covariance");
    const auto count = std::ssize(whole_day::unit_parameters());
    unit.values.resize(count);
    unit.covariance.resize(count, count);
    for (std::size_t k = 0; k < whole_day::unit_parameters().size(); ++k) {
        const std::string name(whole_day::unit_parameters()[k].name);
        if (found.at("parameters").at(k).get<std::string>() != name)
            throw std::invalid_argument("unit.parameters: no " + name);
        const auto row = static_cast<Eigen::Index>(k);
        unit.values(row) = values.at(k).get<double>();
        for (Eigen::Index l = 0; l < count; ++l)
            unit.covariance(row, l) =
                covariance.at(k).at(static_cast<std::size_t>(l)).get<double>();
    }
    const json& noise = found.at("noise");
    unit.noise = {noise.at("placement_mgal").get<double>(), noise.at("flicker_mgal").get<double>(),
                  noise.at("white_mgal").get<double>()};
    for (const double part :
         {unit.noise.placement_mgal, unit.noise.flicker_mgal, unit.noise.white_mgal})
        if (!(part > 0.0)) throw std::invalid_argument("unit.noise: not positive");
    return unit;
}

PlannedUnit unit_of_result(const std::filesystem::path& file) {
    const auto refuse = [&file](const std::string& trouble) {
        return InputError(
            fmt::format("{}: {}; allowed: the result.json of a survey corrected with the model day",
                        file.string(), trouble));
    };
    try {
        const json result = json::parse(text::read_text_file(file));
        const std::string model = result.at("model").get<std::string>();
        if (model != model::kWholeDay) throw refuse("model = " + model);
        const whole_day::UnitPosterior found = posterior_of(result.at("unit"));
        const json& occupations = result.at("occupations");
        PlannedUnit unit{found.priors(), found.noise, walk_of(occupations), tilt_of(occupations),
                         ""};
        unit.origin = fmt::format(
            "the day of {}", occupations.at(0).at("time_utc").get<std::string>().substr(0, 10));
        return unit;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw refuse(std::string("not such a file (") + error.what() + ")");
    }
}

}  // namespace

PlannedUnit usual_unit() {
    return {whole_day::usual_day_priors(), whole_day::kUsualNoise, kUsualWalk_degc_per_sqrt_h,
            kUsualTilt_g, "a usual unit, not measured"};
}

PlannedUnit planned_unit(const std::filesystem::path& file) {
    if (file.extension() == ".json") return unit_of_result(file);
    const unit::Calibration calibration = unit::read_calibration(file);
    PlannedUnit unit = usual_unit();
    unit.priors = model::day_priors_of(calibration);
    // The root of the expected variance: the logarithm is normal.
    if (const auto& placement = calibration.placement)
        unit.noise.placement_mgal = placement->mgal * std::exp(std::pow(placement->log_error(), 2));
    unit.origin = "calibration of unit " + calibration.serial_number;
    return unit;
}

}  // namespace a351::corrector::design
