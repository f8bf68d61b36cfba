#pragma once
/// @file
/// The page of a long record.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"
#include "corrector/report/report.hpp"

namespace a351::corrector {

/// Makes record.html of a long record, with its figures.
/// @param settings         object with every option of the run.
/// @param picture_formats  formats other than SVG, from picture_formats().
[[nodiscard]] Report make_long_record_page(const RecordResult& result,
                                           const nlohmann::ordered_json& settings,
                                           const std::vector<std::string>& picture_formats);

}  // namespace a351::corrector
