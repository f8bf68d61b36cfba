// Preloaded into a daemon, lets it see a host that slept or whose clock was set.
//
// The clocks are those of the real host, changed by the current contents of the file named by
// A351_HOST_CLOCKS, four integers of 8 bytes: time in ns for which the monotonic clocks were
// stopped, time in ns by which UTC is ahead, synchronised (0, 1), and state returned by adjtimex if
// synchronised.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

struct Change {
    std::int64_t slept_ns = 0, ahead_ns = 0, is_synchronised = 0, state = TIME_OK;
};

Change change() {
    Change now;
    const char* const file = std::getenv("A351_HOST_CLOCKS");
    const int descriptor = file ? open(file, O_RDONLY | O_CLOEXEC) : -1;
    if (descriptor < 0) return now;
    if (read(descriptor, &now, sizeof now) != static_cast<ssize_t>(sizeof now)) now = {};
    close(descriptor);
    return now;
}

void add(timespec* time, std::int64_t ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    const std::int64_t total = time->tv_sec * kSecond + time->tv_nsec + ns;
    time->tv_sec = total / kSecond;
    time->tv_nsec = total % kSecond;
}

}  // namespace

extern "C" int clock_gettime(clockid_t id, timespec* time) noexcept {
    const auto result = static_cast<int>(syscall(SYS_clock_gettime, id, time));
    if (id == CLOCK_MONOTONIC || id == CLOCK_MONOTONIC_RAW) add(time, -change().slept_ns);
    if (id == CLOCK_REALTIME) add(time, change().ahead_ns);
    return result;
}

// Converts the deadline from the changed clock above to the kernel's clock.
extern "C" int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      clockid_t id, const timespec* until) {
    using Wait = int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
    static const auto wait = reinterpret_cast<Wait>(dlsym(RTLD_NEXT, "pthread_cond_clockwait"));
    timespec real = *until;
    if (id == CLOCK_MONOTONIC) add(&real, change().slept_ns);
    return wait(condition, mutex, id, &real);
}

extern "C" int adjtimex(timex* kernel) noexcept {
    syscall(SYS_adjtimex, kernel);
    const Change now = change();
    kernel->status = now.is_synchronised ? 0 : STA_UNSYNC;
    if (now.state == TIME_INS) kernel->status |= STA_INS;
    if (now.state == TIME_DEL) kernel->status |= STA_DEL;
    kernel->maxerror = now.is_synchronised ? 1000 : 16'000'000;  // The kernel's NTP_PHASE_LIMIT.
    return now.is_synchronised ? static_cast<int>(now.state) : TIME_ERROR;
}
