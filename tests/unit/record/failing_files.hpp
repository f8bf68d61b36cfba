#pragma once

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "protocol/record/file_layer.hpp"

namespace a351::test {

/// The real files, of which one operation fails: the n-th, counted from 1; 0 never.  For any
/// number of threads.
class FailingFiles : public record::FileLayer {
public:
    explicit FailingFiles(int fail_at = 0) : fail_at_(fail_at) {}

    [[nodiscard]] int operations() const noexcept { return operations_; }
    void fail_at(int n) noexcept { fail_at_ = n; }

    std::unique_ptr<record::AppendFile> open_append(const std::filesystem::path& file) override {
        count();
        return std::make_unique<File>(*this, files_.open_append(file));
    }
    void create_directories(const std::filesystem::path& directory) override {
        count();
        files_.create_directories(directory);
    }
    void sync_directory(const std::filesystem::path& directory) override {
        count();
        files_.sync_directory(directory);
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        count();
        files_.truncate(file, size);
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        count();
        files_.rename(from, to);
    }
    void remove(const std::filesystem::path& file) override {
        count();
        files_.remove(file);
    }

private:
    class File : public record::AppendFile {
    public:
        File(FailingFiles& files, std::unique_ptr<record::AppendFile> file)
            : files_(files), file_(std::move(file)) {}
        void append(std::span<const std::byte> bytes) override {
            try {
                files_.count();
            } catch (...) {
                file_->append(bytes.first(bytes.size() / 2));  // Torn in the middle.
                throw;
            }
            file_->append(bytes);
        }
        void sync() override {
            files_.count();
            file_->sync();
        }
        [[nodiscard]] std::uint64_t size() const override { return file_->size(); }

    private:
        FailingFiles& files_;
        std::unique_ptr<record::AppendFile> file_;
    };

    void count() {
        if (++operations_ == fail_at_) {
            throw std::system_error(EIO, std::generic_category(), "operation made to fail");
        }
    }

    record::FileLayer& files_ = record::posix_files();
    std::atomic<int> fail_at_ = 0;
    std::atomic<int> operations_ = 0;
};

}  // namespace a351::test
