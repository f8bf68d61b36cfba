#include "corrector/figure/program_run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "protocol/text/text_file.hpp"

namespace a351::corrector::figure {
namespace {

void require(int error, const std::string& what) {
    if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

/// The child's standard streams and working directory.
class FileActions {
public:
    FileActions(const std::filesystem::path& directory, const std::filesystem::path& errors) {
        require(::posix_spawn_file_actions_init(&actions_), "posix_spawn_file_actions_init");
        add(STDIN_FILENO, "/dev/null", O_RDONLY);
        add(STDOUT_FILENO, "/dev/null", O_WRONLY);
        add(STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
        require(::posix_spawn_file_actions_addchdir_np(&actions_, directory.c_str()),
                directory.string());
    }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }

    [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    void add(int descriptor, const char* path, int flags) {
        constexpr mode_t kOwnerOnly = 0600;
        require(::posix_spawn_file_actions_addopen(&actions_, descriptor, path, flags, kOwnerOnly),
                path);
    }

    posix_spawn_file_actions_t actions_{};
};

/// Returns a null-terminated list for the C interface.
std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    list.reserve(texts.size() + 1);
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
}

/// Returns our environment with a fixed locale and time zone and with cairo's PDF files left
/// uncompressed.
std::vector<std::string> environment_of_child() {
    std::vector<std::string> variables{"LC_ALL=C.UTF-8", "TZ=UTC0", "CAIRO_DEBUG_PDF=1"};
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view given = *variable;
        if (!given.starts_with("LC_ALL=") && !given.starts_with("TZ="))
            variables.emplace_back(given);
    }
    return variables;
}

/// Returns true if the child ends before the limit, or at once if the kernel is too old to give a
/// descriptor of the child; then the caller waits without a limit.
bool ends_within(pid_t child, std::chrono::milliseconds limit) {
    // The header of glibc 2.36 declares pidfd_open() for C only.
    const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
    if (descriptor < 0) return true;
    const auto deadline = std::chrono::steady_clock::now() + limit;
    pollfd ended{descriptor, POLLIN, 0};
    int ready = 0;
    do {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(
            deadline - std::chrono::steady_clock::now());
        ready = ::poll(&ended, 1, static_cast<int>(std::max<long long>(left.count(), 0)));
    } while (ready < 0 && errno == EINTR);
    ::close(descriptor);
    return ready != 0;
}

}  // namespace

ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& directory, std::chrono::milliseconds limit) {
    const std::filesystem::path errors = std::filesystem::absolute(directory) / "stderr.txt";
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> variables = environment_of_child();
    const FileActions actions(directory, errors);
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, program.c_str(), actions.get(), nullptr,
                                     pointers(words).data(), pointers(variables).data());
    ProgramRun run;
    // EACCES: the file of this name in PATH is no program.  ENOTDIR: PATH names a file as a folder.
    if (error == ENOENT || error == EACCES || error == ENOTDIR) {
        run.is_found = false;
        return run;
    }
    require(error, program);
    if (!ends_within(child, limit)) {
        run.is_timed_out = true;
        ::kill(child, SIGKILL);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) require(errno, program);
    }
    constexpr int kSignalBase = 128;
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
    run.errors = text::read_text_file(errors);
    return run;
}

}  // namespace a351::corrector::figure
