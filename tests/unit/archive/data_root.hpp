#pragma once
/// @file
/// A data root in a temporary directory, with access to the contents of its archive.

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/journal/journal_writer.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/journal/journal_stream.hpp"

namespace a351::archive {

/// Returns the records of a channel in the order of its files; empty if one is damaged.
inline std::vector<DecodedRecord> records_in(const std::filesystem::path& archive,
                                             const std::string& channel,
                                             const journal::StationCodes& codes = {}) {
    std::vector<DecodedRecord> all;
    for (const auto& file : day_files(archive, codes, channel)) {
        const auto bytes = test::read_bytes(file);
        for (std::size_t at = 0; at < bytes.size(); at += kRecordSize) {
            const auto size = std::min(kRecordSize, bytes.size() - at);
            auto record = decode_record(std::span(bytes).subspan(at, size));
            if (!record) return {};
            all.push_back(std::move(*record));
        }
    }
    return all;
}

inline std::vector<std::int32_t> samples_of(const std::vector<DecodedRecord>& records) {
    std::vector<std::int32_t> all;
    for (const auto& record : records)
        all.insert(all.end(), record.samples.begin(), record.samples.end());
    return all;
}

class DataRoot {
public:
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return directory_.path(); }
    [[nodiscard]] std::filesystem::path journal() const { return path() / "journal"; }
    [[nodiscard]] std::filesystem::path archive() const { return path() / "archive"; }

    void write_journal(const std::vector<journal::Chunk>& chunks) const {
        journal::Writer writer(files::posix_files(), journal());
        timing::ClockReading clock;
        for (const auto& chunk : chunks) {
            if (const auto* header = std::get_if<journal::Header>(&chunk)) {
                clock = header->clock;
                writer.begin_segment(*header);
                continue;
            }
            if (const auto* reading = std::get_if<timing::ClockReading>(&chunk)) clock = *reading;
            writer.append(chunk, clock);
        }
        writer.sync();
    }

    void copy_from(const DataRoot& other) const {
        std::filesystem::remove_all(path());
        std::filesystem::copy(other.path(), path(), std::filesystem::copy_options::recursive);
    }

    /// Returns the day files of the archive by name, without the .torn files of cut tails.
    [[nodiscard]] std::map<std::string, std::vector<std::byte>> files() const {
        std::map<std::string, std::vector<std::byte>> content;
        if (!std::filesystem::exists(archive())) return content;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(archive())) {
            if (!entry.is_regular_file() || entry.path().extension() == ".torn") continue;
            content[entry.path().filename().string()] = test::read_bytes(entry.path());
        }
        return content;
    }

    [[nodiscard]] std::vector<DecodedRecord> records(
        const std::string& channel, const journal::StationCodes& codes = {}) const {
        return records_in(archive(), channel, codes);
    }
    [[nodiscard]] std::vector<std::int32_t> counts(const std::string& channel,
                                                   const journal::StationCodes& codes = {}) const {
        return samples_of(records(channel, codes));
    }

private:
    test::TemporaryDirectory directory_;
};

/// Archives the chunks in the archive of the data root.
inline void archive_all(const DataRoot& root, const std::vector<journal::Chunk>& chunks) {
    Writer writer(files::posix_files(), root.archive(), {});
    Archiver archiver(writer);
    for (const auto& chunk : chunks) archiver.take(chunk);
    archiver.close_records();
    static_cast<void>(writer.sync());
}

}  // namespace a351::archive
