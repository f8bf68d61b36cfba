/// Compares an SDS archive with the emulator's truth file, sample by sample.  Reads the archive
/// with libmseed alone, without the project's own readers.
///
///     compare-truth ARCHIVE TRUTH
///
/// Every frame that arrived intact must be in the archive exactly once.  Damaged, lost and repeated
/// frames must not be in it; they would count as altered or duplicated samples.  A frame with a
/// misplaced counter may be in it or not.  Prints one line for each channel, with counts of missing
/// samples and runs of them, and of record boundaries whose time step differs from the truth by
/// more than 15 ms.  Exits with 0 if every channel has matching samples, none altered or
/// duplicated, and no such time step.

#include <libmseed.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace {

// Layout of the truth file: sim/truth/truth-format.md.
enum Fate : std::uint8_t { intact, damaged, lost, repeated, misplaced };
struct TruthRow {
    std::int64_t utc_ns;
    std::int32_t axes[3];
    std::int32_t temperature;
    std::uint16_t count;
    std::uint16_t run;
    std::uint32_t grid_index;
    Fate fate;
    std::uint8_t reserved[7];
};
static_assert(sizeof(TruthRow) == 40);

struct Truth {
    std::vector<TruthRow> rows;  ///< Frames that may be in the archive, in order.
    std::size_t intact = 0, damaged = 0, lost = 0, repeated = 0, misplaced = 0;
};

Truth read_truth(const char* file) {
    std::ifstream in(file, std::ios::binary);
    char header[16];
    if (!in.read(header, sizeof header) || std::memcmp(header, "A351TRU2", 8) != 0) {
        std::fprintf(stderr, "compare-truth: %s is no truth file of version 2\n", file);
        std::exit(1);
    }
    Truth truth;
    TruthRow row;
    while (in.read(reinterpret_cast<char*>(&row), sizeof row)) {
        truth.intact += row.fate == intact;
        truth.damaged += row.fate == damaged;
        truth.lost += row.fate == lost;
        truth.repeated += row.fate == repeated;
        truth.misplaced += row.fate == misplaced;
        if (row.fate == intact || row.fate == misplaced) truth.rows.push_back(row);
    }
    return truth;
}

constexpr std::array kChannels{"BN1", "BN2", "BNZ", "BK1"};

struct ArchivedSample {
    std::array<std::optional<std::int32_t>, kChannels.size()> counts;  // one for each channel
    double time_s;  // relative to the first truth row
    bool starts_record;
    bool follows_gap;
};

/// Returns true if all known channels agree.  A single channel is not enough: its noise takes only
/// some hundred values, which repeat too often to identify a position.
bool is_same(const ArchivedSample& sample, const TruthRow& row) {
    const std::array true_counts{row.axes[0], row.axes[1], row.axes[2], row.temperature};
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
        if (sample.counts[c] && *sample.counts[c] != true_counts[c]) return false;
    }
    return true;
}

struct ArchivedRecord {
    int sequence;
    double start_s;  // relative to the first truth row
    double rate_hz;
    std::vector<std::int32_t> counts;
};

/// Returns the records in the order in which they were written.  After an inserted leap second this
/// is not the order of the day files.
std::vector<ArchivedRecord> read_records(const std::filesystem::path& archive,
                                         const std::string& channel, std::int64_t zero_ns) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(archive)) {
        if (entry.is_regular_file() && entry.path().parent_path().filename() == channel + ".D") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    std::vector<ArchivedRecord> records;
    for (const std::string& file : files) {
        MSRecord* record = nullptr;
        int status = MS_NOERROR;
        while ((status = ms_readmsr(&record, file.c_str(), 0, nullptr, nullptr, 0, 1, 0)) ==
               MS_NOERROR) {
            const auto* values = static_cast<const std::int32_t*>(record->datasamples);
            records.push_back({record->sequence_number,
                               static_cast<double>(record->starttime - zero_ns / 1000) / HPTMODULUS,
                               record->samprate,
                               {values, values + record->numsamples}});
        }
        if (status != MS_ENDOFFILE) {
            std::fprintf(stderr, "%s: libmseed: %s\n", file.c_str(), ms_errorstr(status));
            std::exit(1);
        }
        ms_readmsr(&record, nullptr, 0, nullptr, nullptr, 0, 0, 0);
    }
    std::stable_sort(records.begin(), records.end(),
                     [](const auto& a, const auto& b) { return a.sequence < b.sequence; });
    return records;
}

std::vector<ArchivedSample> read_channel(const std::filesystem::path& archive, std::size_t place,
                                         std::int64_t zero_ns) {
    std::vector<ArchivedSample> samples;
    for (const ArchivedRecord& record : read_records(archive, kChannels[place], zero_ns)) {
        for (std::size_t i = 0; i < record.counts.size(); ++i) {
            const double time_s = record.start_s + static_cast<double>(i) / record.rate_hz;
            const bool follows_gap =
                samples.empty() || time_s - samples.back().time_s > 1.5 / record.rate_hz;
            samples.push_back({{}, time_s, i == 0, follows_gap});
            samples.back().counts[place] = record.counts[i];
        }
    }
    return samples;
}

// Largest error of a time step at a record boundary, in s.  Less than a sample at 50 Hz, and more
// than 12 ms: if the first frames of a stream are all late, the clock is corrected by 200 us per
// second, for up to 60 s within a record.
constexpr double kStep_s = 0.015;

struct Comparison {
    std::size_t first_missing = 0, matched = 0, missing = 0, missing_runs = 0, altered = 0,
                duplicated = 0, steps = 0;
    double largest_time_error_s = 0.0;
};

/// Aligns both at runs of equal samples; in white noise such runs are rarely equal by chance.
Comparison compare(const std::vector<ArchivedSample>& archived,
                   const std::vector<TruthRow>& truth) {
    constexpr std::size_t kRun = 24;
    Comparison result;
    const auto may_be_absent = [&](std::size_t j) { return truth[j].fate == misplaced; };
    const auto count_missing = [&](std::size_t from, std::size_t to) {
        std::size_t missing = 0;
        for (std::size_t j = from; j < to; ++j) missing += !may_be_absent(j);
        if (missing == 0) return;
        if (result.missing_runs == 0) result.first_missing = from;
        result.missing += missing;
        ++result.missing_runs;
    };
    const auto matches_at = [&](std::size_t i, std::size_t j) {
        std::size_t n = 0;
        for (; n < kRun && i + n < archived.size() && j < truth.size(); ++n, ++j) {
            if (n > 0 && archived[i + n].follows_gap) break;
            while (j + 1 < truth.size() && may_be_absent(j) &&
                   !is_same(archived[i + n], truth[j])) {
                ++j;
            }
            if (!is_same(archived[i + n], truth[j])) return false;
        }
        return n > 0;
    };
    std::size_t j = 0, before = 0;
    bool joined = false;
    for (std::size_t i = 0; i < archived.size(); ++i) {
        while (j < truth.size() && may_be_absent(j) && !is_same(archived[i], truth[j])) ++j;
        if (j >= truth.size() || !is_same(archived[i], truth[j])) {
            std::size_t k = j;
            while (k < truth.size() && !matches_at(i, k)) ++k;
            if (k < truth.size()) {
                count_missing(j, k);
                joined = false;
                j = k;
                while (!is_same(archived[i], truth[j])) ++j;
            } else {
                const std::size_t from = j > 5000 ? j - 5000 : 0;
                std::size_t back = from;
                while (back < j && !matches_at(i, back)) ++back;
                if (back < j) {
                    ++result.duplicated;
                } else {
                    ++result.altered;
                    ++j;
                }
                continue;
            }
        }
        if (archived[i].starts_record && joined && truth[j].run == truth[before].run) {
            const double step_s = archived[i].time_s - archived[i - 1].time_s;
            const double true_s =
                static_cast<double>(truth[j].utc_ns - truth[before].utc_ns) * 1e-9;
            if (std::abs(step_s - true_s) > kStep_s) ++result.steps;
        }
        const double truth_s = static_cast<double>(truth[j].utc_ns - truth[0].utc_ns) * 1e-9;
        result.largest_time_error_s =
            std::max(result.largest_time_error_s, std::abs(archived[i].time_s - truth_s));
        ++result.matched;
        before = j++;
        joined = true;
    }
    if (j < truth.size()) count_missing(j, truth.size());
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: compare-truth ARCHIVE TRUTH\n");
        return 2;
    }
    const Truth truth = read_truth(argv[2]);
    if (truth.rows.empty()) {
        std::fprintf(stderr, "compare-truth: %s holds no rows\n", argv[2]);
        return 1;
    }
    std::array<std::vector<ArchivedSample>, kChannels.size()> channels;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        channels[c] = read_channel(argv[1], c, truth.rows[0].utc_ns);
    }
    bool is_good = true;
    for (std::size_t own = 0; own < channels.size(); ++own) {
        std::vector<ArchivedSample> archived = channels[own];
        for (std::size_t c = 0; c < channels.size(); ++c) {
            for (std::size_t i = 0; i < std::min(archived.size(), channels[c].size()); ++i) {
                archived[i].counts[c] = channels[c][i].counts[c];
            }
        }
        const Comparison c = compare(archived, truth.rows);
        std::printf(
            "channel=%s truth=%zu archived=%zu matched=%zu missing=%zu first_missing=%zu "
            "missing_runs=%zu "
            "altered=%zu "
            "duplicated=%zu steps=%zu largest_time_error_s=%.6f damaged=%zu lost=%zu repeated=%zu "
            "misplaced=%zu\n",
            kChannels[own], truth.intact, archived.size(), c.matched, c.missing, c.first_missing,
            c.missing_runs, c.altered, c.duplicated, c.steps, c.largest_time_error_s, truth.damaged,
            truth.lost, truth.repeated, truth.misplaced);
        is_good = is_good && c.altered == 0 && c.duplicated == 0 && c.steps == 0 && c.matched > 0;
    }
    return is_good ? 0 : 1;
}
