#pragma once
/// @file
/// The tables and the JSON of a corrected survey.  Run twice, the bytes are the same.
/// Columns and keys: table-format.md.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "corrector/survey/survey_correction.hpp"

namespace a351::corrector {

/// A file that went into a result, by name (without directory), size and CRC-32 (IEEE 802.3).
struct InputFile {
    std::string role;
    std::string name;
    std::uint64_t byte_count = 0;
    std::uint32_t crc32 = 0;
    std::filesystem::path path = {};  ///< Where it was read.
};

/// @throws InputError  it cannot be read.
[[nodiscard]] InputFile describe_input(std::string role, const std::filesystem::path& file);

[[nodiscard]] std::string occupations_csv(const SurveyCorrection& result);
[[nodiscard]] std::string stations_csv(const SurveyCorrection& result);
[[nodiscard]] std::string models_csv(const SurveyCorrection& result);

/// @param settings  object with every option of the run, in the order to be written.
[[nodiscard]] std::string result_json(const SurveyCorrection& result,
                                      const nlohmann::ordered_json& settings,
                                      const std::vector<InputFile>& inputs);

/// Name (with folders below the result's) and content of a file.
using NamedText = std::pair<std::string, std::string>;

/// The four files of a survey.
[[nodiscard]] std::vector<NamedText> result_files(const SurveyCorrection& result,
                                                  const nlohmann::ordered_json& settings,
                                                  const std::vector<InputFile>& inputs);

/// Writes all files into `directory` under temporary names, then renames them: an error before the
/// first rename leaves every file as it was.  Folders are created when absent.
/// @throws std::system_error  with the path.
void write_together(const std::filesystem::path& directory, const std::vector<NamedText>& files);

}  // namespace a351::corrector
