#pragma once
/// @file
/// The readings that a calibration is measured from, each counted once.

#include <map>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

/// Readings counted twice would make errors smaller by the square root of two.
class CountedReadings {
public:
    /// @param archive_sha256  of the archive's files that the rows were read from.
    /// @param file            the series as the user calls it.
    /// @throws InputError  a row's interval overlaps one of a series before, from the same file.
    void add(const std::vector<SurveyRow>& rows, const std::vector<std::string>& archive_sha256,
             const std::string& file);

private:
    struct Counted {
        UtcTime start, end;
        std::string file;
    };
    std::map<std::string, std::vector<Counted>> of_archive_file_;
};

}  // namespace a351::corrector
