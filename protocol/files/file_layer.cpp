#include "protocol/files/file_layer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

namespace a351::files {

namespace {

[[noreturn]] void fail(const char* operation, const std::filesystem::path& path, int error) {
    throw std::system_error(error, std::generic_category(),
                            std::string(operation) + " " + path.string());
}

// In a data root that others may write, a link would let them choose a file that root writes.
constexpr int kNoLink = O_NOFOLLOW;

class Descriptor {
public:
    Descriptor(const std::filesystem::path& path, int flags) {
        do fd_ = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
        while (fd_ < 0 && errno == EINTR);
        if (fd_ < 0) fail(errno == ELOOP ? "open without following a link" : "open", path, errno);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    // Only synced data are guaranteed, so an error of close() adds no information.
    ~Descriptor() { ::close(fd_); }

    [[nodiscard]] int get() const noexcept { return fd_; }

private:
    int fd_ = -1;
};

class PosixAppendFile : public AppendFile {
public:
    explicit PosixAppendFile(const std::filesystem::path& path)
        : path_(path), file_(path, O_WRONLY | O_CREAT | O_APPEND | kNoLink) {
        struct stat status {};
        if (::fstat(file_.get(), &status) != 0) fail("stat", path_, errno);
        size_ = static_cast<std::uint64_t>(status.st_size);
    }

    void append(std::span<const std::byte> bytes) override {
        std::size_t done = 0;
        while (done < bytes.size()) {
            const ssize_t written = ::write(file_.get(), bytes.data() + done, bytes.size() - done);
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) {
                const int error = errno;
                // On a full disk the first part may have been written: remove it.  If that fails
                // too, readers find a torn tail, which they must tolerate anyway.
                if (::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0) size_ += done;
                fail("append to", path_, error);
            }
            done += static_cast<std::size_t>(written);
        }
        size_ += done;
    }

    void sync() override {
        if (::fdatasync(file_.get()) != 0) fail("sync", path_, errno);
    }

    [[nodiscard]] std::uint64_t size() const override { return size_; }

private:
    std::filesystem::path path_;
    Descriptor file_;
    std::uint64_t size_ = 0;
};

class PosixFiles : public FileLayer {
public:
    std::unique_ptr<AppendFile> open_append(const std::filesystem::path& file) override {
        return std::make_unique<PosixAppendFile>(file);
    }

    void create_directories(const std::filesystem::path& directory) override {
        std::vector<std::filesystem::path> missing;
        auto path = std::filesystem::absolute(directory).lexically_normal();
        if (!path.has_filename()) path = path.parent_path();
        for (; !std::filesystem::exists(path); path = path.parent_path()) missing.push_back(path);
        for (; !missing.empty(); missing.pop_back()) {
            if (::mkdir(missing.back().c_str(), 0755) != 0 && errno != EEXIST)
                fail("create directory", missing.back(), errno);
            sync_directory(missing.back().parent_path());
        }
    }

    void sync_directory(const std::filesystem::path& directory) override {
        const Descriptor opened(directory, O_RDONLY | O_DIRECTORY);
        if (::fsync(opened.get()) != 0) fail("sync directory", directory, errno);
    }

    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        const Descriptor opened(file, O_WRONLY | kNoLink);
        if (::ftruncate(opened.get(), static_cast<off_t>(size)) != 0) fail("truncate", file, errno);
        if (::fsync(opened.get()) != 0) fail("sync", file, errno);
    }

    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        if (::rename(from.c_str(), to.c_str()) != 0) fail("rename", from, errno);
    }

    void remove(const std::filesystem::path& file) override {
        if (::unlink(file.c_str()) != 0) fail("remove", file, errno);
    }

    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        const Descriptor opened(file, O_RDWR | O_CREAT | kNoLink);
        const int error = ::posix_fallocate(opened.get(), 0, static_cast<off_t>(size));
        if (error != 0) fail("allocate", file, error);
        if (::fsync(opened.get()) != 0) fail("sync", file, errno);
        struct stat status {};
        if (::fstat(opened.get(), &status) != 0) fail("stat", file, errno);
        // A file system that compresses zeros away has reserved nothing.
        constexpr std::uint64_t kStatBlock = 512;  // stat(2), st_blocks.
        if (static_cast<std::uint64_t>(status.st_blocks) * kStatBlock < size)
            fail("allocate", file, EOPNOTSUPP);
    }

    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const override {
        std::error_code error;
        const auto space = std::filesystem::space(directory, error);
        return error ? std::nullopt : std::optional<std::uint64_t>(space.available);
    }
};

}  // namespace

FileLayer& posix_files() {
    static PosixFiles files;
    return files;
}

bool has_shape(std::string_view name, std::string_view shape) noexcept {
    return std::ranges::equal(name, shape, [](char c, char wanted) {
        return wanted == '#' ? c >= '0' && c <= '9' : c == wanted;
    });
}

void write_file_atomically(FileLayer& files, const std::filesystem::path& file,
                           std::span<const std::byte> content, std::filesystem::path temporary) {
    if (temporary.empty()) temporary = file.string() + ".tmp";
    // Left by a crash; or a link, which leads nowhere or to a file of somebody else.
    if (std::filesystem::exists(std::filesystem::symlink_status(temporary)))
        files.remove(temporary);
    const auto opened = files.open_append(temporary);
    opened->append(content);
    opened->sync();
    files.rename(temporary, file);
}

void replace_file(FileLayer& files, const std::filesystem::path& file,
                  std::span<const std::byte> content) {
    write_file_atomically(files, file, content);
    files.sync_directory(file.has_parent_path() ? file.parent_path() : ".");
}

}  // namespace a351::files
