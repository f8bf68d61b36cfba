#include "corrector/command/options.hpp"

#include <fmt/core.h>

#include <iostream>
#include <map>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::command {
namespace {

/// Returns the longest beginning of the path that exists.
std::filesystem::path existing_part(std::filesystem::path path) {
    while (path.has_relative_path() && !std::filesystem::exists(path)) path = path.parent_path();
    return path;
}

/// @param allowed  the names that are allowed.
void require_folder(std::string_view name, const std::filesystem::path& path,
                    const std::filesystem::path& folder, std::string_view allowed) {
    const std::filesystem::path existing = existing_part(folder);
    if (std::filesystem::is_directory(existing)) return;
    throw InputError(fmt::format("{} = {}: {} is not a folder; allowed: {}", name, path.string(),
                                 existing.string(), allowed));
}

}  // namespace

void add_column_options(CLI::App& command, std::string& input, std::string& column) {
    add_required(
        command, "--input", "CSV", input,
        "Table with a header line; a column time, time_utc or time_s must ascend in equal steps");
    add_required(command, "--column", "NAME", column,
                 "Column to read; an empty cell is a missing sample");
}

void add_figure_options(CLI::App& command, figure::FigureOptions& options) {
    add_option(command, "--figures", "FORMAT", options.formats,
               "Also write the figures in this format, besides SVG; may be repeated")
        ->allow_extra_args(false)
        ->check(CLI::IsMember(figure::picture_formats()));
    const std::map<std::string, double> widths{
        {fmt::format("{:.0f}mm", figure::kColumn_mm), figure::kColumn_mm},
        {fmt::format("{:.0f}mm", figure::kPage_mm), figure::kPage_mm}};
    command
        .add_option_function<std::string>(
            "--figure-width",
            [&options, widths](const std::string& width) {
                options.print.width_mm = widths.at(width);
            },
            "Width of every figure in print, for one column or a page: 84mm or 170mm. Default: "
            "small "
            "figures 84mm, others 170mm")
        ->type_name("WIDTH")
        ->check(CLI::IsMember(widths));
}

void add_verbose_flag(CLI::App& command, bool& is_verbose) {
    command.add_flag("--verbose", is_verbose,
                     "Also print the readings, all models, and the coefficients of the model used");
}

void add_tide_factors(CLI::App& command, tide::Factors& factors) {
    add_with_default(command, "--delta2", "FACTOR", factors.delta2,
                     "Gravimetric factor of degree 2 (1: rigid Earth)");
    add_with_default(command, "--delta3", "FACTOR", factors.delta3,
                     "Gravimetric factor of degree 3 (1: rigid Earth)");
}

void add_tide_system(CLI::App& command, std::string& system) {
    add_option(command, "--tide-system", "SYSTEM", system,
               "Permanent tide in the gravity that remains. tide-free: none; zero: that of the "
               "deformed Earth; mean: all (default: tide-free)")
        ->check(CLI::IsMember({"tide-free", "zero", "mean"}));
}

tide::Factors tide_factor_options(const tide::Factors& factors) {
    return {number_option("--delta2", factors.delta2, tide::kLeastFactor, tide::kGreatestFactor),
            number_option("--delta3", factors.delta3, tide::kLeastFactor, tide::kGreatestFactor)};
}

UtcTime instant_option(std::string_view name, const std::string& text) {
    if (const auto time = parse_rfc3339(text)) return *time;
    throw InputError(fmt::format(
        "{} = {}: not an instant; allowed: YYYY-MM-DDThh:mm:ss with Z or +hh:mm", name, text));
}

double number_option(std::string_view name, double value, double low, double high) {
    if (value >= low && value <= high) return value;
    throw InputError(fmt::format("{} = {}: out of range; allowed: {} to {}", name,
                                 text::shortest(value), text::shortest(low), text::shortest(high)));
}

void require_file_option(std::string_view name, const std::filesystem::path& path,
                         const std::filesystem::path& input) {
    using Type = std::filesystem::file_type;
    const Type type = std::filesystem::symlink_status(path).type();
    if (!path.has_filename() || (type != Type::not_found && type != Type::regular)) {
        throw InputError(
            fmt::format("{} = {}: not a regular file; allowed: a file", name, path.string()));
    }
    require_folder(name, path, std::filesystem::absolute(path).parent_path(), "a file in a folder");
    std::error_code none;
    if (std::filesystem::equivalent(path, input, none))
        throw InputError(
            fmt::format("{} = {}: is the input; allowed: another file", name, path.string()));
}

void require_folder_option(std::string_view name, const std::filesystem::path& path) {
    require_folder(name, path, std::filesystem::absolute(path), "a folder");
}

void print_warnings(const std::vector<text::Message>& warnings, const std::string& prefix) {
    for (const text::Message& warning : warnings)
        std::cerr << "a351-correct: " << prefix << text::in_words(warning) << '\n';
}

}  // namespace a351::corrector::command
