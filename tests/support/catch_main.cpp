#define CATCH_CONFIG_RUNNER
#include <sys/statvfs.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include "tests/support/catch.hpp"
#include "tests/support/steady_host.hpp"

namespace {

/// Returns true if the directory has room for all tests that run at the same time and can hold
/// executable files.
bool holds_scratch_files(const char* directory) {
    constexpr auto kRoomBytes = 1UL << 30;
    struct statvfs disk {};
    return ::statvfs(directory, &disk) == 0 && (disk.f_flag & ST_NOEXEC) == 0 &&
           disk.f_bavail * disk.f_frsize > kRoomBytes;
}

}  // namespace

/// Scratch files are in memory if possible: these tests simulate disk faults themselves, and
/// waiting for a real disk to sync would take nearly all of their time.
int main(int argc, char** argv) {
    const char* memory = "/dev/shm";
    if (holds_scratch_files(memory)) ::setenv("TMPDIR", memory, 0);
    const bool is_list = std::any_of(
        argv, argv + argc, [](std::string_view word) { return word.starts_with("--list"); });
    if (is_list) return Catch::Session().run(argc, argv);  // Its status is the number of tests.
    HostWatch watch;
    const int status = Catch::Session().run(argc, argv);
    return judge(status, watch.longest_pause(), argv);
}
