#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <vector>

#include "protocol/record/file_bytes.hpp"
#include "protocol/record/file_layer.hpp"

namespace a351::test {

/// The real files, and a copy of what a power cut would leave of them: of a page that was not synced
/// nobody knows whether it reached the disk, nor of a file whose directory was not synced.
class ForgetfulFiles : public record::FileLayer {
public:
    std::unique_ptr<record::AppendFile> open_append(const std::filesystem::path& file) override {
        const std::lock_guard lock(mutex_);
        if (!std::filesystem::exists(file)) unsynced_names_.insert(file);
        return std::make_unique<File>(*this, file, files_.open_append(file));
    }
    void create_directories(const std::filesystem::path& directory) override {
        files_.create_directories(directory);
    }
    void sync_directory(const std::filesystem::path& directory) override {
        const std::lock_guard lock(mutex_);
        files_.sync_directory(directory);
        std::erase_if(unsynced_names_,
                      [&](const auto& file) { return file.parent_path() == directory; });
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        const std::lock_guard lock(mutex_);
        files_.truncate(file, size);
        synced_size_[file] = size;
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        const std::lock_guard lock(mutex_);
        files_.rename(from, to);
        synced_size_[to] = synced_size_[from];
        unsynced_names_.erase(from);
        unsynced_names_.insert(to);
    }
    void remove(const std::filesystem::path& file) override { files_.remove(file); }
    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        files_.allocate(file, size);
    }
    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const override {
        return files_.free_bytes(directory);
    }

    /// What is found of `root` after a cut just now.
    void cut(const std::filesystem::path& root, const std::filesystem::path& found,
             std::mt19937_64& random) {
        const std::lock_guard lock(mutex_);
        std::filesystem::copy(root, found, std::filesystem::copy_options::recursive);
        std::vector<std::filesystem::path> copies;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(found))
            if (entry.is_regular_file()) copies.push_back(entry.path());
        for (const auto& copy : copies) {
            const auto original = root / std::filesystem::relative(copy, found);
            if (unsynced_names_.contains(original) && random() % 2 == 0)
                std::filesystem::remove(copy);
            else
                lose_pages(copy, synced_size_[original], random);
        }
    }

private:
    class File : public record::AppendFile {
    public:
        File(ForgetfulFiles& owner, std::filesystem::path path,
             std::unique_ptr<record::AppendFile> file)
            : owner_(owner), path_(std::move(path)), file_(std::move(file)) {}
        void append(std::span<const std::byte> bytes) override {
            const std::lock_guard lock(owner_.mutex_);
            file_->append(bytes);
        }
        void sync() override {
            const std::lock_guard lock(owner_.mutex_);
            file_->sync();
            owner_.synced_size_[path_] = file_->size();
        }
        [[nodiscard]] std::uint64_t size() const override { return file_->size(); }

    private:
        ForgetfulFiles& owner_;
        std::filesystem::path path_;
        std::unique_ptr<record::AppendFile> file_;
    };

    /// A size between the synced one and the last; of the pages in between any may be zeros.
    static void lose_pages(const std::filesystem::path& file, std::uint64_t synced,
                           std::mt19937_64& random) {
        constexpr std::size_t kPage = 4096;
        auto bytes = record::read_bytes(file);
        bytes.resize(synced + random() % (bytes.size() - synced + 1));
        for (std::size_t page = synced / kPage; page * kPage < bytes.size(); ++page) {
            if (random() % 4 != 0) continue;
            const std::size_t from = std::max<std::size_t>(page * kPage, synced);
            const std::size_t to = std::min((page + 1) * kPage, bytes.size());
            std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                      bytes.begin() + static_cast<std::ptrdiff_t>(to), std::byte{0});
        }
        std::ofstream out(file, std::ios::binary | std::ios::trunc);
        out.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
    }

    record::FileLayer& files_ = record::posix_files();
    std::mutex mutex_;
    std::map<std::filesystem::path, std::uint64_t> synced_size_;
    std::set<std::filesystem::path> unsynced_names_;
};

}  // namespace a351::test
