#include "corrector/command/record_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "corrector/command/options.hpp"
#include "corrector/long_record/csv_record.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/progress_bar.hpp"

namespace a351::corrector::command {
namespace {

/// Returns the data root of a folder or of a day file within its archive; empty for other files.
std::filesystem::path root_of(const std::filesystem::path& file) {
    if (std::filesystem::is_directory(file)) return std::filesystem::canonical(file);
    // ROOT/archive/YEAR/NET/STA/CHAN.D/FILE
    std::filesystem::path root = std::filesystem::canonical(file);
    constexpr int kLevels = 6;
    for (int level = 0; level < kLevels; ++level) root = root.parent_path();
    return std::filesystem::exists(root / "metadata" / "station.xml") ? root
                                                                      : std::filesystem::path();
}

}  // namespace

std::vector<long_record::LongRecord> read_records(const std::vector<std::string>& files,
                                                  const long_record::RecordWindow& window,
                                                  tide::System system) {
    std::vector<std::filesystem::path> roots;
    std::vector<long_record::LongRecord> records;
    {
        text::ProgressBar bar("read");
        for (const std::string& file : files) {
            const std::filesystem::path root = root_of(file);
            if (root.empty()) {
                records.push_back(long_record::read_csv_record(file, window, std::ref(bar)));
            } else if (std::find(roots.begin(), roots.end(), root) == roots.end()) {
                roots.push_back(root);
                records.push_back(
                    long_record::read_archive_record(root, window, std::ref(bar), system));
            }
        }
    }
    for (const long_record::LongRecord& record : records) print_warnings(record.warnings);
    return records;
}

long_record::RecordSegments divide_or_refuse(const long_record::LongRecord& record,
                                             const long_record::SegmentOptions& options,
                                             const std::string& name) {
    long_record::RecordSegments parts = long_record::divide_record(record, options);
    if (!parts.segments.empty()) return parts;
    std::string message = name + ": no part can be analysed";
    for (const long_record::RefusedPart& part : parts.refused)
        message += fmt::format("; from {} {}", to_rfc3339(part.start), part.reason);
    const double shortest_h =
        static_cast<double>(options.shortest) * record.step_s / kSecondsPerHour;
    throw InputError(
        fmt::format("{}; allowed: {} h or more in one piece", message, text::fixed(shortest_h, 1)));
}

}  // namespace a351::corrector::command
