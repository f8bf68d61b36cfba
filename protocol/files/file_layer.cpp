#include "protocol/files/file_layer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "protocol/files/link_refused.hpp"

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
    /// @param folder     an open folder, or AT_FDCWD.
    /// @param operation  operation and whole path, for an error.
    /// @param link       path up to `name`, if that is not the whole path.
    Descriptor(int folder, const std::filesystem::path& name, int flags, const char* operation,
               const std::filesystem::path& path, const std::filesystem::path& link = {}) {
        do fd_ = ::openat(folder, name.c_str(), flags | O_CLOEXEC, 0644);
        while (fd_ < 0 && errno == EINTR);
        if (fd_ >= 0) return;
        const int error = errno;
        if (is_link(folder, name, error)) throw LinkRefused(link.empty() ? path : link);
        fail(operation, path, error);
    }
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    // Only synced data are guaranteed, so an error of close() adds no information.
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }

    [[nodiscard]] int get() const noexcept { return fd_; }

private:
    /// Returns true if a link is the cause of an error: ELOOP, or ENOTDIR for a folder.
    static bool is_link(int folder, const std::filesystem::path& name, int error) {
        struct stat status {};
        return (error == ELOOP || error == ENOTDIR) &&
               ::fstatat(folder, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 &&
               S_ISLNK(status.st_mode);
    }

    int fd_ = -1;
};

/// The work of a layer, which its files count too.
struct Work {
    static constexpr std::uint64_t kBlock = 4096;

    std::atomic<std::uint64_t> bytes{0}, syncs{0};

    /// Counts a sync.
    /// @param from, to  bytes of the file that were not synced before.
    void note(std::uint64_t from, std::uint64_t to) {
        ++syncs;
        if (to > from) bytes += ((to + kBlock - 1) / kBlock - from / kBlock) * kBlock;
    }
};

class PosixAppendFile : public AppendFile {
public:
    PosixAppendFile(const std::filesystem::path& path, Descriptor file, std::shared_ptr<Work> work)
        : path_(path), file_(std::move(file)), work_(std::move(work)) {
        struct stat status {};
        if (::fstat(file_.get(), &status) != 0) fail("stat", path_, errno);
        size_ = synced_size_ = static_cast<std::uint64_t>(status.st_size);
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
        work_->note(synced_size_, size_);
        synced_size_ = size_;
    }

    [[nodiscard]] std::uint64_t size() const override { return size_; }

private:
    std::filesystem::path path_;
    Descriptor file_;
    std::shared_ptr<Work> work_;
    std::uint64_t size_ = 0, synced_size_ = 0;
};

class PosixFiles : public FileLayer {
public:
    explicit PosixFiles(std::filesystem::path root = {})
        : root_(std::move(root)), normal_root_(root_.empty() ? root_ : normal(root_)) {}

    std::unique_ptr<AppendFile> open_append(const std::filesystem::path& file) override {
        return std::make_unique<PosixAppendFile>(
            file, open_file(file, O_WRONLY | O_CREAT | O_APPEND), work_);
    }

    std::unique_ptr<AppendFile> create(const std::filesystem::path& file) override {
        return std::make_unique<PosixAppendFile>(
            file, open_file(file, O_WRONLY | O_CREAT | O_EXCL | O_APPEND), work_);
    }

    void create_directories(const std::filesystem::path& directory) override {
        std::vector<std::filesystem::path> missing;
        auto path = normal(directory);
        for (; !std::filesystem::exists(path); path = path.parent_path()) missing.push_back(path);
        for (; !missing.empty(); missing.pop_back()) {
            const auto& next = missing.back();
            const Descriptor parent = open_folder(next.parent_path(), "create directory", next);
            if (::mkdirat(parent.get(), next.filename().c_str(), 0755) != 0 && errno != EEXIST)
                fail("create directory", next, errno);
            sync_directory(next.parent_path());
        }
    }

    void sync_directory(const std::filesystem::path& directory) override {
        constexpr const char* kSync = "sync directory";
        const Descriptor folder = open_folder(directory, kSync, directory);
        const Descriptor opened(folder.get(), ".", O_RDONLY | O_DIRECTORY, kSync, directory);
        if (::fsync(opened.get()) != 0) fail("sync directory", directory, errno);
        work_->note(0, 1);
    }

    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        const Descriptor opened = open_file(file, O_WRONLY, "truncate");
        if (::ftruncate(opened.get(), static_cast<off_t>(size)) != 0) fail("truncate", file, errno);
        if (::fsync(opened.get()) != 0) fail("sync", file, errno);
        work_->note(0, 0);
    }

    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        const Descriptor source = open_folder(from.parent_path(), "rename", from);
        const Descriptor target = open_folder(to.parent_path(), "rename", to);
        if (::renameat(source.get(), from.filename().c_str(), target.get(),
                       to.filename().c_str()) != 0)
            fail("rename", from, errno);
    }

    void remove(const std::filesystem::path& file) override {
        const Descriptor folder = open_folder(file.parent_path(), "remove", file);
        if (::unlinkat(folder.get(), file.filename().c_str(), 0) != 0) fail("remove", file, errno);
    }

    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        const Descriptor opened = open_file(file, O_RDWR | O_CREAT, "allocate");
        const int error = ::posix_fallocate(opened.get(), 0, static_cast<off_t>(size));
        if (error != 0) fail("allocate", file, error);
        if (::fsync(opened.get()) != 0) fail("sync", file, errno);
        work_->note(0, 0);
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

    [[nodiscard]] DiskWork work() const override { return {work_->bytes, work_->syncs}; }

private:
    /// Returns an absolute path without dots and without a slash at its end.
    static std::filesystem::path normal(const std::filesystem::path& path) {
        const auto made = std::filesystem::absolute(path).lexically_normal();
        return made.has_filename() ? made : made.parent_path();
    }

    /// Opens a folder.  Below the root it opens one folder after the other, because the kernel
    /// follows links in all parts of a path but the last.
    [[nodiscard]] Descriptor open_folder(const std::filesystem::path& folder, const char* operation,
                                         const std::filesystem::path& path) const {
        constexpr int kFlags = O_PATH | O_DIRECTORY;
        const auto below = root_.empty() ? std::filesystem::path("..")
                                         : normal(folder).lexically_relative(normal_root_);
        if (*below.begin() == "..")
            return {AT_FDCWD, folder.empty() ? "." : folder, kFlags, operation, path};
        Descriptor opened(AT_FDCWD, root_, kFlags, operation, path);
        std::filesystem::path reached = root_;
        for (const auto& name : below) {
            reached /= name;
            opened = Descriptor(opened.get(), name, kFlags | kNoLink, operation, path, reached);
        }
        return opened;
    }

    [[nodiscard]] Descriptor open_file(const std::filesystem::path& file, int flags,
                                       const char* operation = "open") const {
        const Descriptor folder = open_folder(file.parent_path(), operation, file);
        return {folder.get(), file.filename(), flags | kNoLink, operation, file};
    }

    std::filesystem::path root_, normal_root_;
    std::shared_ptr<Work> work_ = std::make_shared<Work>();
};

}  // namespace

FileLayer& posix_files() {
    static PosixFiles files;
    return files;
}

std::unique_ptr<FileLayer> files_below(std::filesystem::path root) {
    return std::make_unique<PosixFiles>(std::move(root));
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
    const auto opened = files.create(temporary);
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
