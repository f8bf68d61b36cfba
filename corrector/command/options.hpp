#pragma once
/// @file
/// Options of the commands, and the refusal of their values before the work begins.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Adds an option.
/// @param type   word for the value in the help.
/// @param value  set by the option.
template <class Value>
CLI::Option* add_option(CLI::App& command, const std::string& name, const std::string& type,
                        Value& value, const std::string& text) {
    return command.add_option(name, value, text)->type_name(type);
}

/// Adds an option that must be given.
template <class Value>
CLI::Option* add_required(CLI::App& command, const std::string& name, const std::string& type,
                          Value& value, const std::string& text) {
    return add_option(command, name, type, value, text)->required();
}

/// Adds an option whose default is shown in the help.
template <class Value>
CLI::Option* add_with_default(CLI::App& command, const std::string& name, const std::string& type,
                              Value& value, const std::string& text) {
    return add_option(command, name, type, value, text)->capture_default_str();
}

/// Adds --input and --column, a column for SampleColumn.
void add_column_options(CLI::App& command, std::string& input, std::string& column);

/// Adds --figures, which may be repeated.
void add_figures_option(CLI::App& command, std::vector<std::string>& formats);

/// Adds --delta2 and --delta3.
void add_tide_factors(CLI::App& command, TideFactors& factors);

/// Returns the factors given in options.
/// @throws InputError  one is out of range.
[[nodiscard]] TideFactors tide_factor_options(const TideFactors& factors);

/// Returns the instant given in an option.
/// @throws InputError  it is not RFC 3339.
[[nodiscard]] UtcTime instant_option(std::string_view name, const std::string& text);

/// Returns the value.
/// @throws InputError  it is outside [low, high], or NaN.
double number_option(std::string_view name, double value, double low, double high);

/// Largest ensemble that a command accepts, far above every useful one.
inline constexpr int kMostMembers = 1'000'000;

/// @throws InputError  the path is a folder or a device, or its folder is a file.
void require_file_option(std::string_view name, const std::filesystem::path& path);

/// The same for a folder, which may exist.
void require_folder_option(std::string_view name, const std::filesystem::path& path);

}  // namespace a351::corrector
