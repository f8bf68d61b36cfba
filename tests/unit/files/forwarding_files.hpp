#pragma once

#include "protocol/files/file_layer.hpp"

namespace a351::test {

/// The real files as a base class, whose operations a test may override.
class ForwardingFiles : public files::FileLayer {
public:
    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        return files_.open_append(file);
    }
    void create_directories(const std::filesystem::path& directory) override {
        files_.create_directories(directory);
    }
    void sync_directory(const std::filesystem::path& directory) override {
        files_.sync_directory(directory);
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        files_.truncate(file, size);
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        files_.rename(from, to);
    }
    void remove(const std::filesystem::path& file) override { files_.remove(file); }
    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        files_.allocate(file, size);
    }
    /// Much, so that a host whose disk is nearly full fails no test.
    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path&) const override {
        return std::uint64_t{100} << 30;
    }

protected:
    files::FileLayer& files_ = files::posix_files();
};

/// One real file, likewise.
class ForwardingFile : public files::AppendFile {
public:
    explicit ForwardingFile(std::unique_ptr<files::AppendFile> file) : file_(std::move(file)) {}
    void append(std::span<const std::byte> bytes) override { file_->append(bytes); }
    void sync() override { file_->sync(); }
    [[nodiscard]] std::uint64_t size() const override { return file_->size(); }

protected:
    std::unique_ptr<files::AppendFile> file_;
};

}  // namespace a351::test
