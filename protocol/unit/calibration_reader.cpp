#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::unit {
namespace {

/// Largest magnitude of a covariance, squares of the values' units; a larger one has no
/// information.
constexpr double kGreatestCovariance = 1e12;
constexpr double kLongestWarmUp_h = 1000.0;
/// Range of the placement, mGal: from the resolution of a mean to a thousand times the observed one.
constexpr double kLeastPlacement_mgal = 1e-3, kGreatestPlacement_mgal = 1e3;

struct Range {
    double low, high;
};

/// Range of axis biases, mGal per g: a tenth of g along the axis, fifty times the observed values.
constexpr Range kBiasRange{-1e5, 1e5};
constexpr std::array<Range, 2> kAxisBiasRanges{kBiasRange, kBiasRange};

/// Ranges of slopes, mGal/degC or mGal/(degC/h), a thousand times the observed values; and of
/// logarithms of lags in seconds, from 1 s to two days.
constexpr Range kSlopeRange{-1e4, 1e4}, kLagRange{0.0, 12.0};
constexpr std::array kThermalRanges{kSlopeRange, kSlopeRange, kSlopeRange, kLagRange, kLagRange};

/// Constants within a tenth of g, slopes as above.
constexpr std::array kFacesRanges{kBiasRange, kBiasRange, kSlopeRange, kSlopeRange};

std::string required(text::TomlTable& table, std::string_view key) {
    std::string value = table.string_or(key, "");
    if (value.empty()) table.refuse(key, "missing or empty", "a text");
    return value;
}

std::optional<UtcTime> time_of(text::TomlTable& table, std::string_view key) {
    const std::string text = table.string_or(key, "");
    if (text.empty()) return std::nullopt;
    const auto time = parse_rfc3339(text);
    if (!time) table.refuse(key, "not an instant", "YYYY-MM-DDThh:mm:ss with Z or +hh:mm");
    return time;
}

template <std::size_t kSize>
void require_in_range(const text::TomlTable& table, const std::vector<double>& values,
                      const std::array<std::string_view, kSize>& names,
                      const std::array<Range, kSize>& ranges) {
    for (std::size_t k = 0; k < kSize; ++k) {
        const auto [low, high] = ranges.at(k);
        if (values[k] >= low && values[k] <= high) continue;
        table.refuse("values",
                     fmt::format("{} = {}: out of range", names.at(k), text::shortest(values[k])),
                     fmt::format("{} to {}", text::shortest(low), text::shortest(high)));
    }
}

template <int kCount, std::size_t kSize>
std::optional<CalibratedCoefficients<kCount>> coefficients_of(
    text::TomlTable& document, std::string_view name,
    const std::array<std::string_view, kSize>& names, const std::array<Range, kSize>& ranges) {
    static_assert(kSize == std::size_t{kCount});
    if (!document.has(name)) return std::nullopt;
    text::TomlTable table = document.table(name);
    const std::vector<std::string> found = table.strings("coefficients");
    if (!std::ranges::equal(found, names)) {
        table.refuse("coefficients", "not those of this table, in this order",
                     text::joined({names.begin(), names.end()}));
    }
    constexpr double kAny = std::numeric_limits<double>::max();
    const auto values = table.numbers("values", -kAny, kAny);
    const auto covariance = table.numbers("covariance", -kGreatestCovariance, kGreatestCovariance);
    table.require_all_read();
    const auto require_count = [&table](std::string_view key, std::size_t has, std::size_t wants) {
        if (has != wants)
            table.refuse(key, fmt::format("{} numbers", has), fmt::format("{} numbers", wants));
    };
    require_count("values", values.size(), kSize);
    require_count("covariance", covariance.size(), kSize * kSize);
    require_in_range(table, values, names, ranges);

    CalibratedCoefficients<kCount> part;
    using Matrix = Eigen::Matrix<double, kCount, kCount, Eigen::RowMajor>;
    part.values = Eigen::Map<const Eigen::Matrix<double, kCount, 1>>(values.data());
    part.covariance = Eigen::Map<const Matrix>(covariance.data());
    if (part.covariance != part.covariance.transpose() ||
        !linear_algebra::Cholesky(part.covariance).is_positive_definite())
        table.refuse("covariance", "not a covariance matrix",
                     "a symmetric, positive definite matrix");
    return part;
}

std::optional<Placement> placement_of(text::TomlTable& document) {
    if (!document.has("placement")) return std::nullopt;
    text::TomlTable table = document.table("placement");
    const double mgal = table.required_number("standard_deviation_mgal", kLeastPlacement_mgal,
                                              kGreatestPlacement_mgal);
    const auto limits = table.numbers("limits_mgal", kLeastPlacement_mgal, kGreatestPlacement_mgal);
    table.require_all_read();
    if (limits.size() != 2 || !(limits[0] < mgal && mgal < limits[1]))
        table.refuse("limits_mgal", "not the limits of standard_deviation_mgal",
                     "two numbers, one below and one above it");
    return Placement{mgal, limits[0], limits[1]};
}

std::optional<Scale> scale_of(text::TomlTable& document) {
    constexpr double kGreatestError = 0.1, kLeastDeviation = 1e-6;
    if (!document.has("scale")) return std::nullopt;
    text::TomlTable table = document.table("scale");
    const double value = table.required_number("value", 1.0 - kGreatestError, 1.0 + kGreatestError);
    const double error = table.required_number("standard_error", kLeastDeviation, kGreatestError);
    table.require_all_read();
    return Scale{value, error};
}

std::vector<CalibrationData> data_of(text::TomlTable& document) {
    constexpr std::size_t kDigits = 64;
    std::vector<CalibrationData> list;
    for (text::TomlTable& table : document.tables("data")) {
        CalibrationData data{required(table, "name"), required(table, "sha256")};
        if (data.sha256.size() != kDigits ||
            data.sha256.find_first_not_of("0123456789abcdef") != std::string::npos)
            table.refuse("sha256", "not a SHA-256", "64 lower-case hexadecimal digits");
        table.require_all_read();
        list.push_back(std::move(data));
    }
    return list;
}

}  // namespace

Calibration parse_calibration(std::string_view text, std::filesystem::path origin) {
    text::TomlTable document = text::parse_toml(text, std::move(origin));
    if (!document.has("format")) document.refuse("format", "missing", "1");
    static_cast<void>(document.integer_or("format", 1, 1, 1));
    Calibration calibration;
    calibration.serial_number = required(document, "serial_number");
    calibration.program = required(document, "program");
    const auto from = time_of(document, "valid_from_utc");
    if (!from) document.refuse("valid_from_utc", "missing", "an instant");
    calibration.valid_from = *from;
    calibration.valid_to = time_of(document, "valid_to_utc");
    if (calibration.valid_to && *calibration.valid_to <= *from)
        document.refuse("valid_to_utc", "not after valid_from_utc", "a later instant");
    calibration.data = data_of(document);
    calibration.axis_bias =
        coefficients_of<2>(document, "axis_bias", kAxisBiasNames, kAxisBiasRanges);
    calibration.thermal =
        coefficients_of<kThermalTerms>(document, "thermal", kThermalNames, kThermalRanges);
    if (document.has("warm_up")) {
        text::TomlTable table = document.table("warm_up");
        calibration.warm_up = {table.required_number("within_mgal", 1e-3, 1e3),
                               table.required_number("after_power_on_h", 0.0, kLongestWarmUp_h)};
        table.require_all_read();
    }
    calibration.placement = placement_of(document);
    calibration.scale = scale_of(document);
    calibration.faces = coefficients_of<4>(document, "faces", kFacesNames, kFacesRanges);
    document.require_all_read();
    if (!calibration.axis_bias && !calibration.thermal && !calibration.warm_up &&
        !calibration.placement && !calibration.scale && !calibration.faces)
        document.refuse("axis_bias",
                        "missing, and so are thermal, warm_up, placement, scale and faces",
                        "at least one of axis_bias, thermal, warm_up, placement, scale or faces");
    return calibration;
}

Calibration read_calibration(const std::filesystem::path& file) {
    return parse_calibration(text::read_text_file(file), file);
}

}  // namespace a351::unit
