#pragma once

#include <algorithm>
#include <map>
#include <system_error>

#include "tests/unit/files/forwarding_files.hpp"

namespace a351::test {

/// The real files, on a disk of limited capacity.  For one thread.
class SmallDisk : public ForwardingFiles {
public:
    explicit SmallDisk(std::uint64_t capacity) : capacity_(capacity) {}

    /// Lets others fill the disk up to `free` bytes; empty() removes their data.
    void fill_up_to(std::uint64_t free) { others_ = capacity_ - used() - free; }
    void empty() { others_ = 0; }
    int error_of_allocate = 0;
    int error_when_full = ENOSPC;

    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        auto opened = files_.open_append(file);
        sizes_[file] = opened->size();
        return std::make_unique<File>(*this, file, std::move(opened));
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        files_.truncate(file, size);
        sizes_[file] = size;
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        files_.rename(from, to);
        sizes_[to] = sizes_[from];
        sizes_.erase(from);
    }
    void remove(const std::filesystem::path& file) override {
        files_.remove(file);
        sizes_.erase(file);
    }
    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        if (error_of_allocate != 0)
            throw std::system_error(error_of_allocate, std::generic_category(), "allocate");
        take(file, size - std::min(size, sizes_[file]));
        files_.allocate(file, size);
    }
    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path&) const override {
        return capacity_ - used() - others_;
    }

private:
    class File : public ForwardingFile {
    public:
        File(SmallDisk& disk, std::filesystem::path path, std::unique_ptr<files::AppendFile> file)
            : ForwardingFile(std::move(file)), disk_(disk), path_(std::move(path)) {}
        void append(std::span<const std::byte> bytes) override {
            disk_.take(path_, bytes.size());
            file_->append(bytes);
        }

    private:
        SmallDisk& disk_;
        std::filesystem::path path_;
    };

    [[nodiscard]] std::uint64_t used() const {
        std::uint64_t sum = 0;
        for (const auto& [file, size] : sizes_) sum += size;
        return sum;
    }
    void take(const std::filesystem::path& file, std::uint64_t size) {
        if (used() + others_ + size > capacity_)
            throw std::system_error(error_when_full, std::generic_category(), "small disk");
        sizes_[file] += size;
    }

    std::uint64_t capacity_;
    std::uint64_t others_ = 0;
    std::map<std::filesystem::path, std::uint64_t> sizes_;
};

}  // namespace a351::test
