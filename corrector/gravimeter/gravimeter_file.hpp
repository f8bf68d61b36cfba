#pragma once
/// @file
/// A file of a spring gravimeter: Scintrex CG-5, Scintrex CG-6, ZLS Burris, or a table of readings.
///
///     const GravimeterFile file = read_gravimeter_file("survey.txt");
///     for (const Reading& reading : file.readings) use(reading.time, reading.value);
///
/// The format is known from the content.  Each line is a reading, a comment, or refused with a
/// reason, so that no line is lost without a word.  Formats: gravimeter-format.md.
///
/// Sign: an instrument adds its tide correction to the reading.  The effect of the tide on gravity is
/// the negative of this correction.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::gravimeter {

/// One reading of an instrument.
struct Reading {
    std::size_t line = 0;    ///< Number of its line in the file, from 1.
    std::string instrument;  ///< Make and serial number, for example `CG-5 9379` or `B44`.
    std::string site;        ///< Station, as the file names it.
    UtcTime time;            ///< Time that the file gives for the reading.
    /// Reading with all corrections of the instrument, above the zero of its scale.
    MilliGal value;
    /// Tide correction that `value` contains; absent if the instrument applied none.
    std::optional<MilliGal> tide_correction;
    std::string dial;                  ///< Setting of the dial; empty if there is none.
    int loop = 0;                      ///< Number of its loop, if the file marks their ends.
    std::optional<Metres> height;      ///< Height of the instrument above the mark.
    std::optional<tide::Station> position;  ///< Absent: unknown.
    std::optional<tide::Station> receiver;  ///< Position of the receiver, if the file has it too.
    /// Further columns: name with its unit, and the text of the file.
    std::vector<std::pair<std::string_view, std::string>> kept;
};

/// A line that is neither a reading nor a comment.
struct RefusedLine {
    std::size_t line = 0;  ///< Number in the file, from 1.
    std::string reason;    ///< Reason in a few words.
};

/// The lines of a file: readings, comments and refused ones.
struct GravimeterFile {
    std::filesystem::path path;
    std::string format;                ///< Name of the instrument's make and type.
    std::string layout;                ///< Different columns that were found, for people.
    std::vector<Reading> readings;     ///< In the order of the file.
    std::size_t comment_count = 0;     ///< Headers, names of columns and blank lines.
    std::vector<RefusedLine> refused;  ///< In the order of the file.
};

/// Facts that a file does not have itself.
struct ReadOptions {
    std::optional<std::chrono::minutes> zone;  ///< Local time minus UTC.
};

/// Reads a file.  A last line without a line end is refused, because the file may be cut off there.
/// @throws InputError  the file cannot be read, has no known format or no reading, or needs an option.
[[nodiscard]] GravimeterFile read_gravimeter_file(const std::filesystem::path& path,
                                                  const ReadOptions& options = {});

}  // namespace a351::corrector::gravimeter
