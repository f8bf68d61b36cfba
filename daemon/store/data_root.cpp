#include "daemon/store/data_root.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace a351::daemon::store {
namespace {

constexpr std::array kFolders{"journal", "archive", "metadata", "events", "state"};

void lock(const std::filesystem::path& root, int descriptor) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw DataRootLocked(root.string() + ": another a351d is using this data root");
}

}  // namespace

DataRootLock::DataRootLock(files::FileLayer& files, const std::filesystem::path& root)
    : root_(root) {
    for (const char* name : kFolders) files.create_directories(root / name);
    files.sync_directory(root);  // A start that was killed may not have synced it.
    // The layer refuses a link in place of a folder, which the lock would follow.
    for (const char* name : kFolders) files.sync_directory(root / name);
    try {
        const int folder = open(root, AT_FDCWD, root, O_RDONLY | O_DIRECTORY);
        lock(root, folder);
        // One after the other, because the kernel follows links in all parts of a path but the last.
        const int state = open(root, folder, "state", O_PATH | O_DIRECTORY | O_NOFOLLOW);
        lock(root, open(root, state, "lock", O_RDWR | O_CREAT | O_NOFOLLOW));
    } catch (...) {
        for (const int descriptor : descriptors_) close(descriptor);
        throw;
    }
}

DataRootLock::~DataRootLock() {
    for (const int descriptor : descriptors_) close(descriptor);
}

bool DataRootLock::is_in_place() const noexcept {
    struct stat locked;
    struct stat named;
    // Other faults of the disk are reported elsewhere.
    if (::fstat(descriptors_.front(), &locked) != 0) return true;
    if (::stat(root_.c_str(), &named) != 0) return errno != ENOENT && errno != ENOTDIR;
    return locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
}

int DataRootLock::open(const std::filesystem::path& root, int folder,
                       const std::filesystem::path& name, int flags) {
    const int descriptor = ::openat(folder, name.c_str(), flags | O_CLOEXEC, 0644);
    if (descriptor < 0)
        throw std::system_error(errno, std::generic_category(),
                                root.string() + ": cannot open " + name.string());
    descriptors_.push_back(descriptor);
    return descriptor;
}

}  // namespace a351::daemon::store
