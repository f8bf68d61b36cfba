#include "corrector/command/record_input.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "corrector/command/progress_bar.hpp"
#include "corrector/long_record/csv_record.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
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

std::vector<LongRecord> read_records(const std::vector<std::string>& files,
                                     const RecordWindow& window) {
    std::vector<std::filesystem::path> roots;
    std::vector<LongRecord> records;
    {
        ProgressBar bar(std::cerr, ::isatty(STDERR_FILENO) == 1, "read");
        const Progress progress = [&bar](std::size_t done, std::size_t total) {
            bar.show(done, total);
        };
        for (const std::string& file : files) {
            const std::filesystem::path root = root_of(file);
            if (root.empty()) {
                records.push_back(read_csv_record(file, window, progress));
            } else if (std::find(roots.begin(), roots.end(), root) == roots.end()) {
                roots.push_back(root);
                records.push_back(read_archive_record(root, window, progress));
            }
        }
    }
    for (const LongRecord& record : records)
        for (const std::string& warning : record.warnings)
            std::cerr << "a351-correct: " << warning << '\n';
    return records;
}

RecordSegments divide_or_refuse(const LongRecord& record, const SegmentOptions& options,
                                const std::string& name) {
    RecordSegments parts = divide_record(record, options);
    if (!parts.segments.empty()) return parts;
    std::string message = name + ": no part can be analysed";
    for (const RefusedPart& part : parts.refused)
        message += "; from " + to_rfc3339(part.start) + " " + part.reason;
    throw InputError(
        message + "; allowed: " +
        text::fixed(static_cast<double>(options.shortest) * record.step_s / 3600.0, 1) +
        " h or more in one piece");
}

}  // namespace a351::corrector
