#pragma once
/// @file
/// The subcommands of `a351-correct`, each in NAME_command.cpp.
///
/// Each function adds one subcommand with its options to the program.  The work is done later, when
/// CLI::App::parse() finds the subcommand.  The options live as long as the program object.
///
///     CLI::App program;
///     add_tide_command(program);
///     program.parse(argc, argv);  // does the work
///
/// parse() throws CLI::ParseError or InputError for bad usage or input (exit status 2), and another
/// exception if the work fails (status 1).  Options are checked before the work begins, so that a
/// slip in one of them writes nothing (command_test.cpp).
///
/// Results go to files or standard output, warnings and progress to standard error.  The manual
/// page of each command is a351-correct-NAME(1).

namespace CLI {
class App;
}

namespace a351::corrector::command {

/// `amend`: writes the amendments that the findings of a survey propose into its amendments file.
void add_amend_command(CLI::App& program);
/// `calibrate`: what is to be known of a unit before a survey, measured.  Writes a calibration file
/// for `survey --calibration` and `record --apply`.
void add_calibrate_command(CLI::App& program);
/// `decimate`: one column of a CSV at a lower rate, as CSV `index,value,valid`.  Memory does not
/// grow with the length of the input.
void add_decimate_command(CLI::App& program);
/// `design`: expected uncertainty of a planned survey, and changes that would improve it.
void add_design_command(CLI::App& program);
/// `emd`: the modes and the residue of one column of a CSV, as CSV `imf1,...,residue`.  Prints
/// period and energy of each; no cell of the column may be empty.
void add_emd_command(CLI::App& program);
/// `export`: a channel on an exact grid of UTC, as CSV or miniSEED (export.hpp).
void add_export_command(CLI::App& program);
/// `import`: files of gravimeters as the tables that `table` reads, and every reading as CSV.
void add_import_command(CLI::App& program);
/// `record`: hours to weeks at one point.  Writes tables, result.json and record.html on the
/// longest segment.
void add_record_command(CLI::App& program);
/// `retime`: an archive written again from its journal, with times from both sides.  The given data
/// root is not changed.
void add_retime_command(CLI::App& program);
/// `smooth`: the trend of one column of a CSV, as CSV `index,value,standard_error,weight`.  Missing
/// samples are bridged, outliers get no weight.
void add_smooth_command(CLI::App& program);
/// `survey`: one or more survey days from the archive.  Writes tables, result.json and report.html
/// for each day, and joint tables for several.  A day that cannot be corrected does not stop the
/// others; the program then ends with an error.
void add_survey_command(CLI::App& program);
/// `table`: a survey from averages per occupation.  Writes the same files as `survey`, without
/// figures of records.
void add_table_command(CLI::App& program);
/// `tide`: a series of tides at one place as CSV `time,tide_mgal`, positive where gravity is
/// larger.
void add_tide_command(CLI::App& program);

}  // namespace a351::corrector::command
