// Preloaded into a program, lets it see a disk whose syncs take long, and notes what a power cut
// would keep.
//
// Each sync takes A351_SYNC_MS more.  When it is over, a line `SIZE PATH` is added to the file named
// by A351_SYNCS: the size of the synced file when the sync began.

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

namespace {

void note(int descriptor, off_t size) {
    const char* const list = std::getenv("A351_SYNCS");
    const int opened = list ? open(list, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644) : -1;
    if (opened < 0) return;
    std::array<char, 4096> path{};
    const ssize_t length =
        readlink(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), path.data(), path.size());
    std::string line = std::to_string(size) + ' ';
    if (length > 0) line.append(path.data(), static_cast<std::size_t>(length));
    line += '\n';
    // One write, so that lines of several threads do not mix.
    [[maybe_unused]] const ssize_t written = write(opened, line.data(), line.size());
    close(opened);
}

int slow_sync(int descriptor, long call) {
    struct stat before {};
    fstat(descriptor, &before);
    const auto result = static_cast<int>(syscall(call, descriptor));
    if (const char* const delay_ms = std::getenv("A351_SYNC_MS"))
        std::this_thread::sleep_for(std::chrono::milliseconds(std::atoi(delay_ms)));
    if (result == 0) note(descriptor, before.st_size);
    return result;
}

}  // namespace

extern "C" int fdatasync(int descriptor) { return slow_sync(descriptor, SYS_fdatasync); }
extern "C" int fsync(int descriptor) { return slow_sync(descriptor, SYS_fsync); }
