#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <vector>

#include "protocol/files/file_bytes.hpp"
#include "tests/unit/files/forwarding_files.hpp"

namespace a351::test {

/// The real files, with a record of what has been synced.  cut() copies them as a power cut would
/// leave them: pages that were not synced may be missing, and so may files and directories whose
/// parent was not synced.
class ForgetfulFiles : public ForwardingFiles {
public:
    /// Number of operations until the process is killed.  Later ones fail without an effect.
    std::atomic<int> operations_left{std::numeric_limits<int>::max()};

    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        count();
        const std::lock_guard lock(mutex_);
        if (!std::filesystem::exists(file)) unsynced_names_.insert(file);
        return std::make_unique<File>(*this, file, files_.open_append(file));
    }
    void create_directories(const std::filesystem::path& directory) override {
        if (std::filesystem::exists(directory)) return;
        create_directories(directory.parent_path());
        count();
        {
            const std::lock_guard lock(mutex_);
            std::filesystem::create_directory(directory);
            unsynced_names_.insert(directory);
        }
        sync_directory(directory.parent_path());
    }
    void sync_directory(const std::filesystem::path& directory) override {
        count();
        const std::lock_guard lock(mutex_);
        files_.sync_directory(directory);
        std::erase_if(unsynced_names_,
                      [&](const auto& file) { return file.parent_path() == directory; });
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        count();
        const std::lock_guard lock(mutex_);
        files_.truncate(file, size);
        synced_size_[file] = size;
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        count();
        const std::lock_guard lock(mutex_);
        files_.rename(from, to);
        synced_size_[to] = synced_size_[from];
        unsynced_names_.erase(from);
        unsynced_names_.insert(to);
    }
    void remove(const std::filesystem::path& file) override {
        count();
        files_.remove(file);
    }

    /// Copies `root` to `found` as a power cut at this moment would leave it.
    void cut(const std::filesystem::path& root, const std::filesystem::path& found,
             std::mt19937_64& random) {
        const std::lock_guard lock(mutex_);
        std::filesystem::copy(root, found, std::filesystem::copy_options::recursive);
        for (const auto& name : unsynced_names_)
            if (random() % 2 == 0)
                std::filesystem::remove_all(found / std::filesystem::relative(name, root));
        std::vector<std::filesystem::path> copies;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(found))
            if (entry.is_regular_file()) copies.push_back(entry.path());
        for (const auto& copy : copies) {
            const auto original = root / std::filesystem::relative(copy, found);
            lose_pages(copy, synced_size_[original], random);
        }
    }

private:
    class File : public ForwardingFile {
    public:
        File(ForgetfulFiles& owner, std::filesystem::path path,
             std::unique_ptr<files::AppendFile> file)
            : ForwardingFile(std::move(file)), owner_(owner), path_(std::move(path)) {}
        void append(std::span<const std::byte> bytes) override {
            owner_.count();
            const std::lock_guard lock(owner_.mutex_);
            file_->append(bytes);
        }
        void sync() override {
            owner_.count();
            const std::lock_guard lock(owner_.mutex_);
            file_->sync();
            owner_.synced_size_[path_] = file_->size();
        }

    private:
        ForgetfulFiles& owner_;
        std::filesystem::path path_;
    };

    void count() {
        if (operations_left-- <= 0)
            throw std::system_error(EIO, std::generic_category(), "the process is gone");
    }

    /// Cuts `file` to a random size above the synced one, and zeroes random unsynced pages.
    static void lose_pages(const std::filesystem::path& file, std::uint64_t synced,
                           std::mt19937_64& random) {
        constexpr std::size_t kPage = 4096;
        auto bytes = files::read_bytes(file);
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

    std::mutex mutex_;
    std::map<std::filesystem::path, std::uint64_t> synced_size_;
    std::set<std::filesystem::path> unsynced_names_;
};

}  // namespace a351::test
