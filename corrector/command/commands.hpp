#pragma once
/// @file
/// The subcommands of `a351-correct`, each in NAME_command.cpp.

namespace CLI {
class App;
}

namespace a351::corrector {

/// `calibrate`: what is to be known of a unit before a survey, measured.
void add_calibrate_command(CLI::App& program);
/// `decimate`: one column of a CSV at a lower rate, as CSV `index,value,valid`.
void add_decimate_command(CLI::App& program);
/// `emd`: the modes and the residue of one column of a CSV, as CSV `imf1,...,residue`.
void add_emd_command(CLI::App& program);
/// `export`: a channel on an exact grid of UTC.
void add_export_command(CLI::App& program);
/// `record`: hours to weeks at one point.
void add_record_command(CLI::App& program);
/// `retime`: an archive written again from its journal, with times from both sides.
void add_retime_command(CLI::App& program);
/// `smooth`: the trend of one column of a CSV, as CSV `index,value,standard_error,weight`.
void add_smooth_command(CLI::App& program);
/// `survey`: one or more survey days from the archive.
void add_survey_command(CLI::App& program);
/// `table`: a survey from averages per occupation.
void add_table_command(CLI::App& program);
/// `tide`: a series of tides at one place as CSV `time,tide_mgal`.
void add_tide_command(CLI::App& program);

}  // namespace a351::corrector
