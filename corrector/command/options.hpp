#pragma once
/// @file
/// Options of the commands, and the refusal of their values before the work begins.
///
/// First the options are declared; they set variables when the command line is parsed.  Then the
/// callback checks the values:
///
///     add_required(command, "--step", "S", options->step_s, "Time between two rows");
///     ...
///     const double step_s = number_option("--step", options->step_s, 0.001, 1e6);
///
/// A refusal is an InputError `NAME = VALUE: trouble; allowed: ...`.  The variables must live until
/// the command has been parsed.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::command {

/// Adds an option.  The variable keeps its value if the option is not given.
/// @param name   with its dashes, as "--step"; without dashes it is positional.
/// @param type   word for the value in the help.
/// @param value  set by the option; a vector takes several values.
/// @param text   description in the help.
/// @return the option, for further checks; owned by the command.
template <class Value>
CLI::Option* add_option(CLI::App& command, const std::string& name, const std::string& type,
                        Value& value, const std::string& text) {
    return command.add_option(name, value, text)->type_name(type);
}

/// Adds an option that must be given.  Without it the command line is refused before the callback.
template <class Value>
CLI::Option* add_required(CLI::App& command, const std::string& name, const std::string& type,
                          Value& value, const std::string& text) {
    return add_option(command, name, type, value, text)->required();
}

/// Adds an option whose default is shown in the help: the present value of the variable.
template <class Value>
CLI::Option* add_with_default(CLI::App& command, const std::string& name, const std::string& type,
                              Value& value, const std::string& text) {
    return add_option(command, name, type, value, text)->capture_default_str();
}

/// Adds --input and --column, a column for SampleColumn.  Both must be given.
void add_column_options(CLI::App& command, std::string& input, std::string& column);

/// Adds --figures, which may be repeated, and --figure-width.  Only picture_formats() and the widths
/// of a column and a page are accepted.
void add_figure_options(CLI::App& command, figure::FigureOptions& options);

/// Adds --verbose, for survey_text().
void add_verbose_flag(CLI::App& command, bool& is_verbose);

/// Adds --delta2 and --delta3.  The present factors are the defaults in the help.
void add_tide_factors(CLI::App& command, tide::Factors& factors);

/// Adds --tide-system, for set_tide_system().
void add_tide_system(CLI::App& command, std::string& system);

/// Returns the factors given in options.
/// @throws InputError  one is out of range; allowed are 0.5 to 2.
[[nodiscard]] tide::Factors tide_factor_options(const tide::Factors& factors);

/// Returns the instant given in an option.
/// @param name  of the option, for the message.
/// @param text  RFC 3339 with zone, as parse_rfc3339() reads it.
/// @throws InputError  it is not RFC 3339.
[[nodiscard]] UtcTime instant_option(std::string_view name, const std::string& text);

/// Returns the value.  A whole number may be checked too; the result can then be ignored.
/// @param name       of the option, for the message.
/// @param low, high  limits, both allowed.
/// @throws InputError  it is outside [low, high], or NaN.
double number_option(std::string_view name, double value, double low, double high);

/// Largest ensemble that a command accepts, far above every useful one.
inline constexpr int kMostMembers = 1'000'000;

/// Checks that a file can be written at a path; nothing is created.  An existing regular file is
/// accepted.  The check finds slips, not missing permissions or a full disk.
/// @param input  file that the command reads; empty: none.
/// @throws InputError  the path is a folder or a device, or its folder is a file, or it is the input.
///                     A symbolic link is refused too, as NewFile does.
void require_file_option(std::string_view name, const std::filesystem::path& path,
                         const std::filesystem::path& input = {});

/// The same for a folder, which may exist.
/// @throws InputError  the path, or the longest part of it that exists, is not a folder.
void require_folder_option(std::string_view name, const std::filesystem::path& path);

/// Writes warnings to standard error, each as a line.
/// @param prefix  of each warning, after the name of the program.
void print_warnings(const std::vector<text::Message>& warnings, const std::string& prefix = "");

/// Exit status of a command that has done its work although a part of its input was damaged.
inline constexpr int kDoneInPart = 4;

/// Ends a command with kDoneInPart if its input was damaged; to be called last in its callback.
/// @throws CLI::RuntimeError  caught by main().
inline void report_damaged_input(bool is_damaged) {
    if (is_damaged) throw CLI::RuntimeError("a part of the input is damaged", kDoneInPart);
}

}  // namespace a351::corrector::command
