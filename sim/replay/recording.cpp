#include "sim/replay/recording.hpp"

#include <algorithm>
#include <fstream>

#include "protocol/core/input_error.hpp"
#include "protocol/journal/journal_codec.hpp"
#include "sim/replay/archive_recording.hpp"
#include "sim/replay/journal_recording.hpp"

namespace a351::sim::replay {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAllowed = "; allowed: journal segments, or miniSEED files of a data root";

/// Returns true for the name of a day file, which ends in year and day of the year: ".2026.060".
bool is_day_file(const fs::path& file) {
    constexpr std::string_view kShape = ".####.###";
    const std::string name = file.filename().string();
    return name.size() >= kShape.size() &&
           files::has_shape(std::string_view(name).substr(name.size() - kShape.size()), kShape);
}

struct Expanded {
    std::vector<fs::path> files;
    std::vector<RecordingDamage> damage;  ///< Segments skipped.
};

/// Adds the segments of a directory.  A segment without a whole header, left by a writer that was
/// killed as it began the segment, is skipped, as the daemon does at its next start.
void add_segments(const fs::path& directory, const std::vector<fs::path>& segments,
                  Expanded& expanded) {
    const std::size_t before = expanded.files.size();
    for (const fs::path& segment : segments) {
        journal::Reader reader(segment);
        if (!reader.next() && !reader.damage().empty())
            expanded.damage.push_back(reader.damage().front());
        else
            expanded.files.push_back(segment);
    }
    if (expanded.files.size() == before) {
        throw InputError(directory.string() + ": no journal segment in it has a whole header" +
                         kAllowed);
    }
}

void add_day_files(const fs::path& directory, Expanded& expanded) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.is_regular_file() && is_day_file(entry.path())) found.push_back(entry.path());
    }
    std::ranges::sort(found);
    if (found.empty()) {
        throw InputError(directory.string() + ": neither journal segments nor day files in it" +
                         kAllowed);
    }
    expanded.files.insert(expanded.files.end(), found.begin(), found.end());
}

Expanded expand(const std::vector<fs::path>& given) {
    Expanded expanded;
    for (const fs::path& path : given) {
        if (!fs::exists(path)) throw InputError(path.string() + ": no such file" + kAllowed);
        if (!fs::is_directory(path)) {
            expanded.files.push_back(path);
        } else if (const auto segments = journal::segment_files(path); !segments.empty()) {
            add_segments(path, segments, expanded);
        } else if (const auto of_root = journal::segment_files(path / "journal");
                   !of_root.empty()) {
            add_segments(path, of_root, expanded);
        } else {
            add_day_files(path, expanded);
        }
    }
    return expanded;
}

bool is_journal(const fs::path& file) {
    std::array<char, journal::kMagic.size()> magic{};
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file.string() + ": cannot be read" + kAllowed);
    in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (in.gcount() == 0) throw InputError(file.string() + ": empty" + kAllowed);
    return std::string_view(magic.data(), magic.size()) == journal::kMagic;
}

/// Sorts the segments by their numbers, within neighbours of the same directory that have numbers.
void order_segments(std::vector<fs::path>& files) {
    for (auto begin = files.begin(); begin != files.end();) {
        const auto end = std::find_if(begin, files.end(), [&](const fs::path& file) {
            return file.parent_path() != begin->parent_path() || !journal::segment_number(file);
        });
        std::stable_sort(begin, end, [](const fs::path& a, const fs::path& b) {
            return *journal::segment_number(a) < *journal::segment_number(b);
        });
        begin = end == begin ? std::next(begin) : end;
    }
}

}  // namespace

Extent extent_of(Recording& recording) {
    class Nowhere final : public device::LineSink {
        void send(std::span<const std::byte>, UtcTime, const truth::Record*) override {}
        [[nodiscard]] bool is_full() const override { return false; }
    } nowhere;
    Extent extent{UtcTime::max(), UtcTime::min()};
    do {
        const RecordedUnit& unit = recording.unit();
        device::RegisterMachine machine(*unit.profile, unit.identity, Nanoseconds(0));
        for (auto due = recording.next_due(machine); due; due = recording.next_due(machine)) {
            extent.first = std::min(extent.first, *due);
            extent.last = std::max(extent.last, *due);
            recording.send_next(machine, *due, nowhere);
        }
        ++extent.sessions;
    } while (recording.begin_next_session());
    return extent;
}

std::unique_ptr<Recording> open_recording(const RecordingFiles& input) {
    auto [files, damage] = expand(input.files);
    const auto first_archive = std::stable_partition(files.begin(), files.end(), is_journal);
    if (first_archive == files.begin()) {
        return std::make_unique<ArchiveRecording>(
            std::make_unique<ArchiveSource>(files, input.axes), input.archive_unit);
    }
    if (first_archive != files.end()) {
        throw InputError(first_archive->string() +
                         ": not a journal segment, but given together with one" + kAllowed +
                         ", not both");
    }
    order_segments(files);
    return std::make_unique<JournalRecording>(std::move(files), std::move(damage));
}

}  // namespace a351::sim::replay
