#include "corrector/command/counted_readings.hpp"

#include "protocol/core/input_error.hpp"

namespace a351::corrector {

void CountedReadings::add(const std::vector<SurveyRow>& rows,
                          const std::vector<std::string>& archive_sha256, const std::string& file) {
    std::vector<Counted> added;
    added.reserve(rows.size());
    for (const SurveyRow& row : rows)
        added.push_back({row.start.value_or(row.time), row.end.value_or(row.time), file});
    for (const std::string& sha256 : archive_sha256) {
        std::vector<Counted>& before = of_archive_file_[sha256];
        for (const Counted& one : added)
            for (const Counted& other : before)
                if (one.start <= other.end && other.start <= one.end)
                    throw InputError(file + ": the readings at " + to_rfc3339(one.start) +
                                     " are those of " + other.file +
                                     " again; allowed: each reading once");
        before.insert(before.end(), added.begin(), added.end());
    }
}

}  // namespace a351::corrector
