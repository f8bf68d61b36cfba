#pragma once
/// @file
/// Choice of the tide of a survey, and its application to the rows.
///
/// A choice is made from the text of an option or a survey file, and then applied to all rows:
///
///     Choice choice;                        // direct, factors 1.16 and 1.07
///     set_tide_option(choice, "tide.csv");      // or a name
///     apply_tide(rows, sites, choice);
///     describe_tide(settings, choice);          // what was done, for result.json
///
/// All tides here are the effect on gravity: positive if gravity is larger, to be subtracted from a
/// reading.  A series with the opposite sign must be inverted before it is used.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/day_record.hpp"
#include "corrector/reading/survey_row.hpp"
#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector::tide {

/// The source of a survey's tide.
///
/// If `series` is not empty, it is used, and `source` is only its name in results.  Set both with
/// the functions below, which keep them consistent.
struct Choice {
    /// Name: given (column of the table), direct = catalogue, longman, none; or the file name of
    /// `series`.
    std::string source = "direct";
    /// Factors of direct and longman; both begin with those of Factors.  Set kLongmanFactors
    /// here if those are wanted.  Other sources ignore them.
    Factors factors;
    std::filesystem::path series;  ///< CSV for Series::read(); empty: `source` is one of the names.
    /// System of the gravity that remains.  Only direct and longman can give each one; a given tide has
    /// the one that its table names, or tide_free if it names none.
    System system = System::tide_free;
    std::optional<System> given_system =
        {};  ///< From the table of a given tide; absent: not known.
};

/// Allowed values of a tide, for messages and help.
inline constexpr std::string_view kTideSources =
    "given, direct, catalogue, longman, none, or a CSV time,tide_mgal";

/// Sets the source from its name, or from a file name relative to `directory`.
///
/// A name is preferred to a file of the same name.  The file is not read yet.  The factors do not
/// change.
///
/// @param text  a name (lower case), or a path; an absolute path is used without `directory`.
/// @param directory  directory of the file that contains `text`; empty: the current directory.
/// @return false, and nothing is changed, if `text` is neither a name nor a regular file.
/// @throws std::filesystem::filesystem_error  the file's type cannot be found out.
[[nodiscard]] bool set_tide_source(Choice& choice, const std::string& text,
                                   const std::filesystem::path& directory);

/// Sets the source from the text of the option --tide; files are relative to the current directory.
/// @throws InputError  if `text` is neither a name nor a regular file.
/// @throws std::filesystem::filesystem_error  as set_tide_source().
void set_tide_option(Choice& choice, const std::string& text);

/// Allowed names of a tide system, for messages and help.
inline constexpr std::string_view kTideSystems = "tide-free, zero or mean";

/// Takes the system that the rows name for their given tide, if the source is `given`; call it after
/// the source is set.
/// @param origin  name of the table, for the message.
/// @throws InputError  the rows name something that is no system, or several.
void take_given_system(Choice& choice, const std::vector<reading::SurveyRow>& rows,
                       const std::string& origin);

/// Sets the system from the text of the option --tide-system or of the key tide_system; call it
/// after the source is set, and after take_given_system().
/// @param origin  what begins the message: "--tide-system", or file and key.
/// @throws InputError  the text is no system, or the tide is not computed and its system is another
///                     one or, beside tide-free, not known.
void set_tide_system(Choice& choice, const std::string& text, const std::string& origin);

/// Returns the model of a computed source: direct, catalogue, longman or none.
/// `direct` and `catalogue` are one model: it agrees with the harmonic catalogue within 0.0001
/// mGal.
/// @throws InputError  if the source is another one; names those allowed.
[[nodiscard]] Model tide_model(const std::string& source);

/// Sets the tide of every row, and of every bin of the day, from the chosen source.
///
/// The tide is that at the row's `time`, the middle of its averaging interval, or at the bin's
/// `time`.  An earlier tide is overwritten.  A series serves all sites alike; a bin that it does not
/// cover gets the tide of its row.  `given` is the row's given_tide.  The other sources need the
/// position of each site; also `none` refuses a site that is not in the table.
///
/// If an exception is thrown, the rows before the one at fault may have their new tide already.
///
/// @param rows  any order; may be empty.
/// @param sites  table of the sites; not used for a series or for `given`.
/// @param day  record of these rows; null: there are only averages.
/// @throws InputError  as tide_model() or Series::read(); if a row's site is not in `sites`, a
///                     row has no given tide, or the series does not cover a row.
void apply_tide(std::vector<reading::SurveyRow>& rows, const std::vector<text::Site>& sites,
                const Choice& choice, reading::DayRecord* day = nullptr);

/// Returns warnings about a tide that is not computed: factors other than the usual ones, which have
/// no effect on it; and, of `given` or a series, that it is not that of the times and places of the
/// rows (find_doubt() with kTideOfAnyTable), or 0 throughout.  Readings of an hour or two do not show
/// the latter, because the mean difference is left out.
/// @param rows  after apply_tide(); those of sites without a position are left out.
[[nodiscard]] std::vector<text::Message> tide_warnings(const std::vector<reading::SurveyRow>& rows,
                                                       const std::vector<text::Site>& sites,
                                                       const Choice& choice);

/// Adds source, model, sign and factors of the tide to the settings of a result.  The factors are
/// null if the tide is not computed.
/// The keys are tide, tide_model, tide_sign, tide_system, permanent_tide, delta2 and delta3.  Keys that exist are
/// overwritten.
/// Example: tests/unit/tide/tide_series_test.cpp.
/// @throws InputError  as tide_model(), without a series.
void describe_tide(nlohmann::ordered_json& settings, const Choice& choice);

}  // namespace a351::corrector::tide
