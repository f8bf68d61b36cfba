#include "protocol/child/child_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

namespace a351::child {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Longest time until `stop`, the limits and the end of a child with open pipes are looked at.
constexpr milliseconds kLookAround{100};
// The same for a child that has closed its pipes, as every child does at its end.
constexpr milliseconds kEndIsNear{5};
// Part of standard error that is kept.
constexpr std::size_t kMostMessage = 4096;
// Status of a child that could not become the program, as in a shell.
constexpr int kNotStarted = 127;
// Badness added to the child: 1000 would always kill it first, -1000 never.
constexpr char kOomScore[] = "800";
// linux/ioprio.h, which Debian 12 does not install for programs: class idle of this process.
constexpr int kIoWhoProcess = 1, kIoClassIdle = 3, kIoClassShift = 13;

int require(int result, const std::string& what) {
    if (result < 0) throw std::system_error(errno, std::generic_category(), what);
    return result;
}

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
        require(pipe2(ends.data(), O_CLOEXEC), "pipe2");
        read.reset(ends[0]);
        write.reset(ends[1]);
        fcntl(read.get(), F_SETFL, O_NONBLOCK);
    }
};

/// Blocks all signals of this thread.  A handler of this process would otherwise run in the child
/// before it becomes the program.
class BlockedSignals {
public:
    BlockedSignals() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;
    ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

private:
    sigset_t before_{};
};

/// Returns the file of a program as an absolute path, because the child changes its directory;
/// empty if there is none.
std::string program_file(const std::string& name) {
    const auto is_program = [](const std::string& file) {
        std::error_code ignored;
        return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
    };
    const auto absolute = [](const std::string& file) {
        return std::filesystem::absolute(file).string();
    };
    if (name.find('/') != std::string::npos) return is_program(name) ? absolute(name) : "";
    const char* const path = getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
        if (const std::string file = folder + '/' + name; !folder.empty() && is_program(file))
            return absolute(file);
    return {};
}

/// Returns the given variables, and those of this process with other names.
std::vector<std::string> environment(const std::vector<std::string>& given) {
    std::vector<std::string> variables = given;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view inherited = *variable;
        const std::string_view name = inherited.substr(0, inherited.find('=') + 1);
        if (std::ranges::none_of(given, [&](const auto& one) { return one.starts_with(name); }))
            variables.emplace_back(inherited);
    }
    return variables;
}

/// Returns a null-terminated list for the C interface.
std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
}

/// All that the child needs.  It is made before fork(), because a child of a program with threads
/// must not allocate.
struct Start {
    const char* file;
    char* const* words;
    char* const* variables;
    std::array<int, 3> streams;
    int directory;  ///< Less than 0: that of this process.
    pid_t parent;
    bool is_background;
};

void limit(__rlimit_resource resource, rlim_t most, rlim_t at_last) {
    const rlimit both{most, at_last};
    setrlimit(resource, &both);
}

/// Makes the child the least important process.
void step_back() {
    const sched_param lowest{};
    sched_setscheduler(0, SCHED_IDLE, &lowest);
    syscall(SYS_ioprio_set, kIoWhoProcess, 0, kIoClassIdle << kIoClassShift);
    const int oom = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (oom >= 0 && write(oom, kOomScore, sizeof kOomScore - 1) > 0) close(oom);
}

/// Gives the child its standard streams and no other descriptor.
void take_streams(std::array<int, 3> streams) {
    // The descriptors may be 0, 1 or 2 themselves, if this process has closed its own streams.
    for (int& stream : streams) stream = fcntl(stream, F_DUPFD, STDERR_FILENO + 1);
    for (int number = 0; number < 3; ++number)
        dup2(streams[static_cast<std::size_t>(number)], number);
    close_range(STDERR_FILENO + 1, ~0U, 0);
}

/// Becomes the program.  Between fork() and execve() only calls are allowed that are safe in a
/// signal handler.  A limit that the host refuses is not set.
[[noreturn]] void become(const Start& start, const ChildLimits& limits) {
    constexpr char kRefused[] = "the host refuses to start it\n";
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != start.parent) _exit(kNotStarted);
    setpgid(0, 0);
    for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    const bool is_there = start.directory < 0 || fchdir(start.directory) == 0;
    take_streams(start.streams);

    if (start.is_background) step_back();
    if (limits.memory_bytes > 0) limit(RLIMIT_AS, limits.memory_bytes, limits.memory_bytes);
    // SIGXCPU, and SIGKILL a second later.
    if (limits.cpu_s > 0) limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1);
    limit(RLIMIT_CORE, 0, 0);
    if (is_there) execve(start.file, start.words, start.variables);
    _exit(write(STDERR_FILENO, kRefused, sizeof kRefused - 1) < 0 ? EXIT_FAILURE : kNotStarted);
}

/// A running child, which is killed with its group and reaped at the end.
class Child {
public:
    Child(const Start& start, const ChildLimits& limits) {
        const BlockedSignals blocked;
        number_ = fork();
        if (number_ == 0) become(start, limits);
        require(number_, "fork");
        setpgid(number_, number_);  // The child does the same; the first of both counts.
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (status_) return;
        kill(-number_, SIGKILL);
        waitpid(number_, nullptr, 0);
    }

    /// Returns the status of a child that has ended.
    std::optional<int> status() {
        int status = 0;
        if (!status_ && require(waitpid(number_, &status, WNOHANG), "waitpid") == number_)
            status_ = status;
        return status_;
    }

private:
    pid_t number_ = 0;
    std::optional<int> status_;
};

/// Appends the data that a pipe has; closes it at its end.
void drain(Descriptor& pipe, std::string& text, std::size_t most) {
    std::array<char, 65536> buffer;
    while (pipe.get() >= 0 && text.size() <= most) {
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

/// Fills in how a child ended by itself.
void describe(ChildEnd& end, int status, const std::string& errors) {
    if (WIFEXITED(status)) {
        end.status = WEXITSTATUS(status);
        if (end.status == 0) return;
        end.outcome = Outcome::failed;
        end.message = "it ended with status " + std::to_string(end.status);
    } else if (WTERMSIG(status) == SIGXCPU) {
        end.outcome = Outcome::too_slow;
        end.message = "it reached its limit of processor time";
    } else {
        end.status = WTERMSIG(status);
        end.outcome = Outcome::killed;
        end.message = "signal " + std::to_string(end.status) + " ended it";
    }
    if (const std::string line = last_line(errors); !line.empty()) end.message = line;
}

}  // namespace

ChildEnd run_child(const Command& command, const ChildLimits& limits,
                   const std::atomic<bool>* stop) {
    const std::string file = program_file(command.words.front());
    if (file.empty())
        return {Outcome::missing, 0, {}, "there is no program " + command.words.front()};
    std::vector<std::string> words = command.words, variables = environment(command.variables);
    const std::vector<char*> word_list = pointers(words), variable_list = pointers(variables);
    Pipe output, error;
    const Descriptor nothing(require(open("/dev/null", O_RDONLY | O_CLOEXEC), "/dev/null"));
    const Descriptor directory(
        command.directory.empty()
            ? -1
            : require(open(command.directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC),
                      command.directory.string()));
    const auto deadline = steady_clock::now() + limits.time;
    Child child({file.c_str(),
                 word_list.data(),
                 variable_list.data(),
                 {nothing.get(), output.write.get(), error.write.get()},
                 directory.get(),
                 getpid(),
                 command.is_background},
                limits);
    output.write.reset();
    error.write.reset();

    ChildEnd end;
    std::string errors;
    while (true) {
        std::array<pollfd, 2> pipes{
            {{output.read.get(), POLLIN, 0}, {error.read.get(), POLLIN, 0}}};
        const bool are_open = output.read.get() >= 0 || error.read.get() >= 0;
        poll(pipes.data(), pipes.size(),
             static_cast<int>((are_open ? kLookAround : kEndIsNear).count()));
        const std::optional<int> status = child.status();
        drain(output.read, end.output, limits.output_bytes);
        drain(error.read, errors, kMostMessage);
        if (errors.size() > kMostMessage) errors.erase(0, errors.size() - kMostMessage);
        if (stop != nullptr && *stop) {
            end.outcome = Outcome::stopped;
        } else if (end.output.size() > limits.output_bytes) {
            end.outcome = Outcome::too_much_output;
            end.message = "it printed too much";
        } else if (status) {
            describe(end, *status, errors);
        } else if (steady_clock::now() > deadline) {
            end.outcome = Outcome::too_slow;
            end.message = "it reached its time limit";
        } else {
            continue;
        }
        return end;
    }
}

}  // namespace a351::child
