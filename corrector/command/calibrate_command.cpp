#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "corrector/command/calibrate_records.hpp"
#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/series/placement_series.hpp"
#include "corrector/series/tilt_series.hpp"
#include "corrector/series/tumble_series.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/doubtful_site.hpp"
#include "protocol/text/progress_bar.hpp"
#include "protocol/text/write_together.hpp"
#include "protocol/unit/calibration_origin.hpp"

namespace a351::corrector::command {
namespace {

struct CalibrateOptions {
    std::vector<std::string> tilt, tumble, placement, records;
    std::string out, merge, valid_from, valid_to, power_on;
    double within_mgal = unit::WarmUpGuidance{}.within_mgal;
    bool is_within_given = false;
};

/// Reads a survey file, or makes one for a data root with a sites.csv.
job::SurveyFile series_file(const std::filesystem::path& path) {
    return std::filesystem::is_directory(path) ? job::survey_of_root(path, path / "sites.csv")
                                               : job::read_survey_file(path);
}

/// The readings that a calibration is measured from, each counted once.  Counted twice they would
/// make errors smaller by the square root of two.
class CountedReadings {
public:
    /// @param archive_sha256  of the archive's files that the rows were read from.
    /// @param file            the series as the user calls it.
    /// @throws InputError  a row's interval overlaps one of a series before, from the same file.
    void add(const std::vector<reading::SurveyRow>& rows,
             const std::vector<std::string>& archive_sha256, const std::string& file) {
        std::vector<Counted> added;
        for (const reading::SurveyRow& row : rows)
            added.push_back({row.first_instant(), row.last_instant(), file});
        for (const std::string& sha256 : archive_sha256) {
            std::vector<Counted>& before = of_archive_file_[sha256];
            for (const Counted& one : added)
                for (const Counted& other : before)
                    if (one.start <= other.end && other.start <= one.end)
                        throw InputError(fmt::format(
                            "{}: the readings at {} are those of {} again; allowed: each reading "
                            "once",
                            file, to_rfc3339(one.start), other.file));
            before.insert(before.end(), added.begin(), added.end());
        }
    }

private:
    struct Counted {
        UtcTime start, end;
        std::string file;
    };
    std::map<std::string, std::vector<Counted>> of_archive_file_;
};

std::string series_text(const series::TiltSeries& series, const std::string& name) {
    std::string lines =
        fmt::format("{}: {} set-ups, temperature within {} degC, set-ups scatter by {} mGal\n",
                    name, series.set_ups, text::fixed(series.temperature_range_degc, 3),
                    text::fixed(series.placement_mgal, 2));
    for (const std::size_t axis : {0U, 1U}) {
        const auto k = static_cast<Eigen::Index>(axis);
        lines += fmt::format("  {} tilted from {} to {} deg: bias {} +- {} mGal\n",
                             axis == 0 ? "x" : "y", text::fixed(series.least_tilt_deg.at(axis), 2),
                             text::fixed(series.greatest_tilt_deg.at(axis), 2),
                             text::fixed(series.bias.values(k), 1),
                             text::fixed(std::sqrt(series.bias.covariance(k, k)), 1));
    }
    return lines;
}

/// Biases of the horizontal axes to write, and the series or file that they come from.
struct AxisBiasChoice {
    std::optional<unit::AxisBias> bias;
    std::string source;

    /// Takes other biases if there are none yet, or if the sum of their variances is smaller.
    void offer(const std::optional<unit::AxisBias>& other, const std::string& from) {
        if (other && bias) say_contradiction(*other, from);
        if (!other || (bias && bias->covariance.trace() <= other->covariance.trace())) return;
        bias = other;
        source = from;
    }
    /// Returns the biases in a line; empty without any.
    [[nodiscard]] std::string text() const {
        if (!bias) return "";
        return fmt::format(
            "biases of the horizontal axes, written from {}: x {} +- {}, y {} +- {} mGal/g\n",
            source, text::fixed(bias->values(0), 1),
            text::fixed(std::sqrt(bias->covariance(0, 0)), 1), text::fixed(bias->values(1), 1),
            text::fixed(std::sqrt(bias->covariance(1, 1)), 1));
    }

private:
    void say_contradiction(const unit::AxisBias& other, const std::string& from) const {
        constexpr double kMost = 18.4;  // chi-square with 2 degrees of freedom, p = 1e-4
        const auto difference = (other.values - bias->values).eval();
        const auto covariance = (other.covariance + bias->covariance).eval();
        const double square = difference.dot(covariance.ldlt().solve(difference));
        if (square <= kMost) return;
        print_warnings(
            {text::message(
                "the axis biases of {} are {} standard uncertainties from those of {}: are "
                "axes and unit the same?",
                from, text::fixed(std::sqrt(square), 0), source)},
            "");
    }
};

/// Adds parts that this run has not measured, and more certain axis biases, with the data they come
/// from.
void take_over(unit::Calibration& calibration, AxisBiasChoice& axis_bias, const std::string& file) {
    const unit::Calibration other = unit::read_calibration(file);
    if (other.serial_number != calibration.serial_number)
        throw InputError(fmt::format("{}: serial_number = {}: another unit; allowed: {}", file,
                                     other.serial_number, calibration.serial_number));
    axis_bias.offer(other.axis_bias, file);
    if (!calibration.thermal) calibration.thermal = other.thermal;
    if (!calibration.warm_up) calibration.warm_up = other.warm_up;
    if (!calibration.placement) calibration.placement = other.placement;
    if (!calibration.scale) calibration.scale = other.scale;
    if (!calibration.faces) calibration.faces = other.faces;
    for (const unit::CalibrationData& data : other.data) unit::list_data(calibration, data);
    calibration.valid_from = std::max(calibration.valid_from, other.valid_from);
    calibration.valid_to = other.valid_to;
}

/// Reads the series of an option one by one; each reading counts once.
/// @param measure     takes the readings, the name of the series and its file as the user gave it.
/// @param is_tumbled  as SurveySource::is_tumbled.
template <class Measure>
void read_series(unit::Calibration& calibration, const std::vector<std::string>& files,
                 Measure measure, bool is_tumbled = false) {
    CountedReadings counted;
    for (const std::string& file : files) {
        job::SurveyFile survey = series_file(file);
        survey.is_tumbled = is_tumbled;
        text::ProgressBar bar(survey.name);
        const reading::OccupationRows read = job::read_survey(survey, std::ref(bar));
        print_warnings(read.warnings, survey.name + ": ");
        if (const text::Message doubt = text::doubtful_site(read.sites); !doubt.empty())
            print_warnings({doubt}, survey.name + ": ");
        measure(read, survey.name, file);
        const UtcTime start = read.rows.front().first_instant();
        counted.add(read.rows,
                    unit::note_origin(calibration, read.serial_number, start, read.inputs, file),
                    file);
    }
}

void calibrate_from_tilt(unit::Calibration& calibration, AxisBiasChoice& axis_bias,
                         const std::vector<std::string>& files) {
    std::vector<series::TiltSeries> all;
    read_series(calibration, files,
                [&all](const reading::OccupationRows& read, const std::string& name,
                       const std::string& file) {
                    all.push_back(series::measure_axis_bias(read, file));
                    std::cout << series_text(all.back(), name);
                });
    axis_bias.offer(series::combine(all), "the tilt series");
}

std::string tumble_text(const series::Tumble& tumble, const std::string& name) {
    const auto value = [](const series::TumbleTerm& term, int decimals, const char* unit) {
        return fmt::format("{} +- {}{}{}", text::fixed(term.value, decimals),
                           text::fixed(term.standard_error, decimals), unit,
                           term.is_determined ? "" : " (not determined)");
    };
    std::string lines = fmt::format(
        "{}: {} positions at {} degC (within {}), gravity {} +- {} mGal, a position is expected "
        "within {} mGal{}\n",
        name, tumble.positions, text::fixed(tumble.mean_degc, 2), text::fixed(tumble.range_degc, 2),
        text::fixed(tumble.gravity.value(), 3), text::fixed_or(tumble.u_gravity, 3, "?"),
        text::fixed(tumble.expected_mgal, 1),
        tumble.residual_mgal ? fmt::format(", found {}", text::fixed(*tumble.residual_mgal, 1))
                             : ", nothing is left over to test it");
    for (std::size_t k = 0; k < tumble.axes.size(); ++k) {
        const series::TumbleAxis& axis = tumble.axes.at(k);
        lines += fmt::format("  {}: mean of up and down {}, scale {}; bias {}, quadratic term {}\n",
                             series::kTumbleAxes.at(k), value(axis.zero_mgal, 1, " mGal"),
                             value(axis.scale, 6, ""), value(axis.bias_mgal, 1, " mGal"),
                             value(axis.quadratic_mgal, 1, " mGal at 1 g"));
    }
    for (std::size_t k = 0; k < tumble.angle_rad.size(); ++k)
        lines += fmt::format("  {}: 90 deg minus their angle {}\n", series::kTumblePairs.at(k),
                             value(tumble.angle_rad.at(k), 6, " rad"));
    lines += fmt::format("  scale of the reading, z up: {}{}\n", value(tumble.slope, 6, ""),
                         tumble.slope.is_determined
                             ? ""
                             : "; needed for the quadratic term: twelve more positions, two axes "
                               "at about 45 deg in each");
    if (tumble.faces) {
        const unit::Faces& faces = *tumble.faces;
        const auto error = [&faces](Eigen::Index k) { return std::sqrt(faces.covariance(k, k)); };
        const unit::ScaleShare share = unit::scale_share_of(faces);
        lines += fmt::format(
            "  z by temperature: bias {} +- {}, scale {} +- {} mGal/degC; share of the scale {}\n",
            text::fixed(faces.values(2), 2), text::fixed(error(2), 2),
            text::fixed(faces.values(3), 2), text::fixed(error(3), 2),
            share.is_measured ? fmt::format("{} +- {}", text::fixed(share.mean, 2),
                                            text::fixed(share.deviation, 2))
                              : "not determined");
    }
    return lines + (tumble.axis_bias ? ""
                                     : "  biases of the horizontal axes: not determined with their "
                                       "angles to z, so not written; --tilt measures them\n");
}

void calibrate_from_tumble(unit::Calibration& calibration, AxisBiasChoice& axis_bias,
                           const std::vector<std::string>& files) {
    reading::OccupationRows all;
    series::Tumble tumble;
    read_series(
        calibration, files,
        [&](const reading::OccupationRows& read, const std::string& name, const std::string& file) {
            tumble = series::measure_tumble(read, file);
            std::cout << tumble_text(tumble, name);
            all.rows.insert(all.rows.end(), read.rows.begin(), read.rows.end());
            if (!tumble.u_gravity)
                std::cerr << fmt::format(
                    "a351-correct: {}: {} has no u_gravity_mgal in the table of sites, so the "
                    "error of the scale lacks that of gravity\n",
                    name, read.rows.front().site);
            axis_bias.offer(tumble.axis_bias, file);
        },
        true);
    if (files.size() > 1) {
        tumble = series::measure_tumble(all, "--tumble");
        std::cout << tumble_text(tumble, "all together");
    }
    calibration.scale = tumble.scale;
    calibration.faces = tumble.faces;
}

std::string placement_text(const unit::Placement& placement) {
    return fmt::format("{} mGal (95 %: {} to {})", text::fixed(placement.mgal, 2),
                       text::fixed(placement.low_mgal, 2), text::fixed(placement.high_mgal, 2));
}

void calibrate_from_placement(unit::Calibration& calibration,
                              const std::vector<std::string>& files) {
    std::vector<series::PlacementSeries> all;
    read_series(
        calibration, files,
        [&](const reading::OccupationRows& read, const std::string& name, const std::string& file) {
            all.push_back(series::measure_placement(read, calibration, file));
            const series::PlacementSeries& series = all.back();
            std::cout << fmt::format(
                "{}: {} set-ups, placement {}; flicker {}, white noise {} mGal\n", name,
                series.set_ups, placement_text(series.placement),
                text::fixed(series.noise.flicker_mgal, 2), text::fixed(series.noise.white_mgal, 2));
        });
    calibration.placement = series::combine(all);
    if (all.size() > 1)
        std::cout << "all series: placement " << placement_text(*calibration.placement) << '\n';
}

/// Checks that a calibration can be written at a path: over no other file, for example an input.
void require_output(const std::filesystem::path& out) {
    require_file_option("--out", out);
    if (!std::filesystem::exists(out)) return;
    try {
        static_cast<void>(unit::read_calibration(out));
    } catch (const InputError&) {
        throw InputError(fmt::format(
            "--out = {}: exists and is no calibration file; allowed: a new file, or one to replace",
            out.string()));
    }
}

RecordCalibrationOptions record_options(const CalibrateOptions& options) {
    RecordCalibrationOptions records;
    records.files = options.records;
    number_option("--within", options.within_mgal, 1e-3, 1e3);
    if (options.is_within_given) records.within_mgal = options.within_mgal;
    if (!options.power_on.empty())
        records.power_on = instant_option("--power-on", options.power_on);
    return records;
}

void calibrate(const CalibrateOptions& options) {
    if (options.tilt.empty() && options.tumble.empty() && options.placement.empty() &&
        options.records.empty())
        throw InputError(
            "no record and no series; allowed: FILE..., --tilt FILE..., --tumble FILE..., "
            "--placement FILE...");
    require_output(options.out);
    if (options.records.empty() && (options.is_within_given || !options.power_on.empty()))
        throw InputError(
            fmt::format("{}: has no effect without a long record; allowed: with FILE...",
                        options.power_on.empty() ? "--within" : "--power-on"));
    unit::Calibration calibration;
    calibration.program = "a351-correct " A351_VERSION;
    AxisBiasChoice axis_bias;
    if (!options.tilt.empty()) calibrate_from_tilt(calibration, axis_bias, options.tilt);
    if (!options.tumble.empty()) calibrate_from_tumble(calibration, axis_bias, options.tumble);
    calibration.axis_bias = axis_bias.bias;
    if (!options.records.empty())
        std::cout << calibrate_from_records(calibration, record_options(options));
    // Last, because the other parts are the priors of its fit.
    if (!options.placement.empty()) calibrate_from_placement(calibration, options.placement);
    if (!options.merge.empty()) take_over(calibration, axis_bias, options.merge);
    calibration.axis_bias = axis_bias.bias;
    std::cout << axis_bias.text();
    if (!options.valid_from.empty())
        calibration.valid_from = instant_option("--valid-from", options.valid_from);
    if (!options.valid_to.empty())
        calibration.valid_to = instant_option("--valid-to", options.valid_to);
    if (calibration.valid_to && *calibration.valid_to <= calibration.valid_from)
        throw InputError(
            fmt::format("{} = {}: not after {}; allowed: a later instant, by --valid-to",
                        options.valid_to.empty() ? options.merge + ": valid_to_utc" : "--valid-to",
                        to_rfc3339(*calibration.valid_to), to_rfc3339(calibration.valid_from)));
    const std::filesystem::path out = std::filesystem::absolute(options.out);
    text::write_together(out.parent_path(),
                         {{out.filename().string(), unit::to_toml(calibration)}});
    std::cout << "unit " << calibration.serial_number << ": written to " << options.out << '\n';
}

}  // namespace

void add_calibrate_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "calibrate",
        "Measures properties of one unit before a survey and writes them to a calibration file.");
    const auto options = std::make_shared<CalibrateOptions>();
    add_option(command, "FILE", "", options->records,
               "Long records at one point, for the response to temperature: data roots, day files "
               "of their archives, or CSV files")
        ->check(CLI::ExistingPath);
    add_option(command, "--tilt", "FILE", options->tilt,
               "Tilt series at one point, for the biases of the horizontal axes: survey files "
               "(TOML) or data roots with a sites.csv");
    add_option(command, "--tumble", "FILE", options->tumble,
               "Sensor in six or more positions at one point of known gravity, each axis up and "
               "down, for the scale factor: survey files (TOML) or data roots with a sites.csv");
    add_option(
        command, "--placement", "FILE", options->placement,
        "Repeated set-ups at one point, for their scatter: survey files (TOML) or data roots "
        "with a sites.csv");
    CLI::Option* within = add_with_default(command, "--within", "MGAL", options->within_mgal,
                                           "The unit counts as warmed up when its reading is "
                                           "within this many mGal of the final value (0.001-1000)");
    add_option(command, "--power-on", "UTC", options->power_on,
               "Instant at which the sensor was switched on (RFC 3339), at most half an hour "
               "before a record begins");
    add_required(command, "--out", "FILE", options->out, "Calibration to write (TOML)");
    add_option(command, "--merge", "FILE", options->merge,
               "Calibration of the same unit; parts that are not measured now are taken from it");
    add_option(command, "--valid-from", "UTC", options->valid_from,
               "Start of the validity (RFC 3339; default: the first reading)");
    add_option(command, "--valid-to", "UTC", options->valid_to,
               "End of the validity (RFC 3339; default: until a newer calibration)");
    command.callback([options, within] {
        options->is_within_given = within->count() > 0;
        calibrate(*options);
    });
}

}  // namespace a351::corrector::command
