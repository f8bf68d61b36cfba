#include "daemon/bundle/recorded_files.hpp"

#include <algorithm>
#include <ranges>
#include <string_view>
#include <system_error>

#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::daemon::bundle {
namespace {

namespace fs = std::filesystem;

// Time for which a file may have bytes that are not synced: twice the interval of the archive.
constexpr std::chrono::seconds kUnsynced{60};

constexpr std::string_view kCompressed = ".zst";

/// Adds a file with its present size.
/// @return false if it is not there.
bool add(std::vector<RecordedFile>& files, const fs::path& root, const fs::path& path) {
    try {
        auto open = std::make_shared<const OpenFile>(path);
        RecordedFile file{path, path.lexically_relative(root).generic_string(), open->size(),
                          open->time()};
        const bool is_changing = file.time > std::chrono::system_clock::now() - kUnsynced;
        const bool may_go = file.name.starts_with("journal/") && !file.name.ends_with(kCompressed);
        if (is_changing || may_go) file.open = std::move(open);
        files.push_back(std::move(file));
        return true;
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::no_such_file_or_directory) return false;
        throw;
    }
}

/// Returns the regular files below a folder, sorted by their paths; none without the folder.
std::vector<fs::path> files_below(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code absent;
    for (const auto& entry : fs::recursive_directory_iterator(folder, absent))
        if (fs::is_regular_file(entry.symlink_status())) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::vector<fs::path> day_files(const fs::path& archive, UtcTime from) {
    constexpr std::string_view kShape = ".####.###";
    const UtcTime day = std::chrono::floor<std::chrono::days>(from);
    std::vector<fs::path> files = files_below(archive);
    std::erase_if(files, [&](const fs::path& file) {
        const std::string name = file.filename().string();
        const std::size_t end = name.size() - std::min(name.size(), kShape.size());
        return !files::has_shape(std::string_view(name).substr(end), kShape) ||
               archive::day_of(file) < day;
    });
    return files;
}

std::vector<fs::path> months(const fs::path& events, UtcTime from) {
    constexpr std::string_view kShape = "####-##.jsonl";
    const std::string first = to_rfc3339(from).substr(0, std::string_view("YYYY-MM").size());
    std::vector<fs::path> files = files_below(events);
    std::erase_if(files, [&](const fs::path& file) {
        const std::string name = file.filename().string();
        return !files::has_shape(name, kShape) || name < first;
    });
    return files;
}

std::vector<fs::path> segments(const fs::path& journal, UtcTime from) {
    std::vector<fs::path> segments = journal::segment_files(journal);
    auto first = std::ranges::find_if(segments, [&](const fs::path& segment) {
        const auto time = journal::segment_time(segment);
        return time && *time >= from;
    });
    if (first != segments.begin()) --first;
    segments.erase(segments.begin(), first);
    return segments;
}

/// Returns the bytes of a log up to the end of its last whole line.
std::uint64_t whole_lines(const RecordedFile& log) {
    constexpr std::uint64_t kBlock = 4096;
    for (std::uint64_t end = log.size; end > 0;) {
        const std::uint64_t begin = end - std::min(end, kBlock);
        const auto newline = log.read(begin, end - begin).rfind('\n');
        if (newline != std::string::npos) return begin + newline + 1;
        end = begin;
    }
    return 0;
}

/// Returns the bytes of a segment up to the end of its last whole chunk.
std::uint64_t whole_chunks(const fs::path& segment) {
    journal::Reader reader(segment);
    while (reader.next()) {
    }
    return reader.end();
}

void cut_to_whole_parts(std::vector<RecordedFile>& files) {
    for (RecordedFile& file : files) {
        if (file.name.starts_with("archive/")) file.size -= file.size % archive::kRecordSize;
        if (file.name.starts_with("events/")) file.size = whole_lines(file);
    }
    const bool has_segment = !files.empty() && files.back().name.starts_with("journal/");
    if (has_segment && !files.back().name.ends_with(kCompressed))
        files.back().size = whole_chunks(files.back().path);
}

}  // namespace

std::string RecordedFile::read(std::uint64_t offset, std::uint64_t count) const {
    return open ? open->read(offset, count) : OpenFile(path).read(offset, count);
}

std::vector<RecordedFile> recorded_files(const fs::path& root, UtcTime from) {
    std::vector<RecordedFile> files;
    for (const fs::path& file : day_files(root / "archive", from)) add(files, root, file);
    add(files, root, root / "metadata" / "station.xml");
    for (const fs::path& file : months(root / "events", from)) add(files, root, file);
    for (const fs::path& segment : segments(root / "journal", from))
        if (!add(files, root, segment))  // It was compressed, or removed, since it was listed.
            add(files, root, segment.string() + std::string(kCompressed));
    cut_to_whole_parts(files);
    for (const RecordedFile& file : files | std::views::reverse)
        if (file.open) file.open->sync();
    std::erase_if(files, [](const RecordedFile& file) { return file.size == 0; });
    return files;
}

}  // namespace a351::daemon::bundle
