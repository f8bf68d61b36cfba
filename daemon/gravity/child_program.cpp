#include "daemon/gravity/child_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <tuple>
#include <utility>

namespace a351::daemon::gravity {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Longest time until `stop` and the limits are looked at.
constexpr milliseconds kLookAround{100};
// Part of standard error that is kept.
constexpr std::size_t kMostMessage = 4096;
// Badness added to the child: 1000 would always kill it first, -1000 never.
constexpr char kOomScore[] = "800";
// linux/ioprio.h, which Debian 12 does not install for programs: class idle of this process.
constexpr int kIoWhoProcess = 1, kIoClassIdle = 3, kIoClassShift = 13;

/// A descriptor that is closed at the end.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { reset(); }
    void reset(int number = -1) {
        if (number_ >= 0) close(number_);
        number_ = number;
    }
    [[nodiscard]] int get() const noexcept { return number_; }

private:
    int number_;
};

struct Pipe {
    Descriptor read, write;
    Pipe() {
        std::array<int, 2> ends{};
        if (pipe2(ends.data(), O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe2");
        read.reset(ends[0]);
        write.reset(ends[1]);
        fcntl(read.get(), F_SETFL, O_NONBLOCK);
    }
};

void limit(__rlimit_resource resource, rlim_t most, rlim_t at_last) {
    const rlimit both{most, at_last};
    setrlimit(resource, &both);
}

/// Becomes the program.  Between fork() and execv() only calls are allowed that are safe in a signal
/// handler.  A limit that the host refuses is not set.
[[noreturn]] void become(char* const* command, const ChildLimits& limits, pid_t parent,
                         const std::array<int, 3>& streams) {
    constexpr int kNotStarted = 127;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kNotStarted);
    setpgid(0, 0);  // Ctrl-C in a terminal is for the daemon, which then ends its child.
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    signal(SIGPIPE, SIG_DFL);
    for (int stream = 0; stream < 3; ++stream)
        dup2(streams[static_cast<std::size_t>(stream)], stream);
    close_range(STDERR_FILENO + 1, ~0U, 0);

    const sched_param lowest{};
    sched_setscheduler(0, SCHED_IDLE, &lowest);
    syscall(SYS_ioprio_set, kIoWhoProcess, 0, kIoClassIdle << kIoClassShift);
    if (limits.memory_bytes > 0) limit(RLIMIT_AS, limits.memory_bytes, limits.memory_bytes);
    limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1);  // SIGXCPU, and SIGKILL a second later.
    limit(RLIMIT_CORE, 0, 0);
    const int oom = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (oom >= 0 && write(oom, kOomScore, sizeof kOomScore - 1) > 0) close(oom);
    execv(command[0], command);
    _exit(kNotStarted);
}

/// Appends what a pipe has; closes it at its end.
void drain(Descriptor& pipe, std::string& text, std::size_t most) {
    std::array<char, 65536> buffer;
    while (text.size() <= most) {
        const ssize_t count = read(pipe.get(), buffer.data(), buffer.size());
        if (count > 0) {
            text.append(buffer.data(), static_cast<std::size_t>(count));
        } else {
            if (count == 0 || (errno != EAGAIN && errno != EINTR)) pipe.reset();
            return;
        }
    }
}

std::string last_line(const std::string& text) {
    const auto end = text.find_last_not_of(" \n");
    if (end == std::string::npos) return {};
    const auto before = text.find_last_of('\n', end);
    const auto begin = before == std::string::npos ? 0 : before + 1;
    return text.substr(begin, end + 1 - begin);
}

/// Returns the trouble in the status of a child that ended by itself.
std::pair<std::string, std::string> trouble_of(int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    if (WIFEXITED(status))
        return {"failed", "it ended with status " + std::to_string(WEXITSTATUS(status))};
    if (WTERMSIG(status) == SIGXCPU) return {"too_slow", "it reached its limit of processor time"};
    return {"killed", "signal " + std::to_string(WTERMSIG(status)) + " ended it"};
}

}  // namespace

ChildEnd run_child(std::vector<std::string> command, const ChildLimits& limits,
                   const std::atomic<bool>& stop) {
    if (access(command.front().c_str(), X_OK) != 0)
        return {"no_corrector", {}, "there is no program " + command.front()};
    std::vector<char*> words;
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    Pipe output, error;
    const Descriptor nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));

    const auto deadline = steady_clock::now() + limits.time;
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0) return {"failed", {}, "fork: " + std::generic_category().message(errno)};
    if (child == 0)
        become(words.data(), limits, parent,
               {nothing.get(), output.write.get(), error.write.get()});
    output.write.reset();
    error.write.reset();

    ChildEnd end;
    std::string errors;
    int status = 0;
    bool is_alive = true;
    const auto is_overdue = [&]() -> bool {
        if (stop)
            end.trouble = "stopped";
        else if (end.output.size() > limits.output_bytes)
            end.trouble = "too_much_output";
        else if (steady_clock::now() > deadline)
            end.trouble = "too_slow";
        return !end.trouble.empty();
    };
    while (is_alive && !is_overdue()) {
        std::array<pollfd, 2> pipes{
            {{output.read.get(), POLLIN, 0}, {error.read.get(), POLLIN, 0}}};
        const bool are_open = output.read.get() >= 0 || error.read.get() >= 0;
        poll(pipes.data(), pipes.size(), are_open ? static_cast<int>(kLookAround.count()) : 5);
        if (output.read.get() >= 0) drain(output.read, end.output, limits.output_bytes);
        if (error.read.get() >= 0) drain(error.read, errors, kMostMessage);
        if (errors.size() > kMostMessage) errors.erase(0, errors.size() - kMostMessage);
        if (output.read.get() < 0 && error.read.get() < 0)
            is_alive = waitpid(child, &status, WNOHANG) == 0;
    }
    if (is_alive) {
        kill(-child, SIGKILL);  // its group; there is none yet if it has only just been started
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        end.message = end.trouble == "too_slow"          ? "it reached its time limit"
                      : end.trouble == "too_much_output" ? "it printed too much"
                                                         : "";
    } else {
        std::tie(end.trouble, end.message) = trouble_of(status);
        if (const std::string line = last_line(errors); !end.trouble.empty() && !line.empty())
            end.message = line;
    }
    return end;
}

}  // namespace a351::daemon::gravity
