#include "sim/replay/open_recording.hpp"

#include <algorithm>
#include <fstream>

#include "protocol/core/input_error.hpp"
#include "protocol/record/journal_codec.hpp"
#include "protocol/record/journal_reader.hpp"
#include "sim/replay/archive_recording.hpp"
#include "sim/replay/journal_recording.hpp"

namespace a351::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAllowed = "; allowed: journal segments, or miniSEED files of a data root";

/// Day files end in year and day of the year: ".2026.060".
bool is_day_file(const fs::path& file) {
    constexpr std::string_view kShape = ".####.###";
    const std::string name = file.filename().string();
    if (name.size() < kShape.size()) return false;
    return std::equal(kShape.begin(), kShape.end(), name.end() - kShape.size(),
                      [](char wanted, char found) {
                          return wanted == '#' ? found >= '0' && found <= '9' : found == wanted;
                      });
}

std::vector<fs::path> files_in(const fs::path& directory) {
    std::vector<fs::path> found = record::journal_segments(directory);
    if (!found.empty()) return found;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.is_regular_file() && is_day_file(entry.path())) found.push_back(entry.path());
    }
    std::ranges::sort(found);
    if (found.empty()) {
        throw InputError(directory.string() + ": neither journal segments nor day files in it" +
                         kAllowed);
    }
    return found;
}

std::vector<fs::path> expand(const std::vector<fs::path>& given) {
    std::vector<fs::path> files;
    for (const fs::path& path : given) {
        if (!fs::exists(path)) throw InputError(path.string() + ": no such file" + kAllowed);
        if (fs::is_directory(path)) {
            const auto inside = files_in(path);
            files.insert(files.end(), inside.begin(), inside.end());
        } else {
            files.push_back(path);
        }
    }
    return files;
}

bool is_journal(const fs::path& file) {
    std::array<char, record::kJournalMagic.size()> magic{};
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file.string() + ": cannot be read" + kAllowed);
    in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (in.gcount() == 0) throw InputError(file.string() + ": empty" + kAllowed);
    return std::string_view(magic.data(), magic.size()) == record::kJournalMagic;
}

/// By their numbers, where neighbours lie in the same directory and both have one.
void order_segments(std::vector<fs::path>& files) {
    for (auto begin = files.begin(); begin != files.end();) {
        const auto end = std::find_if(begin, files.end(), [&](const fs::path& file) {
            return file.parent_path() != begin->parent_path() || !record::segment_number(file);
        });
        std::stable_sort(begin, end, [](const fs::path& a, const fs::path& b) {
            return *record::segment_number(a) < *record::segment_number(b);
        });
        begin = end == begin ? std::next(begin) : end;
    }
}

}  // namespace

std::unique_ptr<Recording> open_recording(const RecordingFiles& input) {
    std::vector<fs::path> files = expand(input.files);
    const auto first_archive = std::stable_partition(files.begin(), files.end(), is_journal);
    if (first_archive == files.begin()) {
        return std::make_unique<ArchiveRecording>(
            std::make_unique<ArchiveSource>(files, input.axes), input.archive_unit);
    }
    if (first_archive != files.end()) {
        throw InputError(first_archive->string() + ": no journal segment, beside one" + kAllowed +
                         ", not both");
    }
    order_segments(files);
    return std::make_unique<JournalRecording>(std::move(files));
}

}  // namespace a351::sim
