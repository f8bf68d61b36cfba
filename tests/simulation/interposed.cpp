/// @file
/// Functions of the C library that put threads under the Schedule of their process and on the clocks
/// of its Host.  The definitions in a program take precedence over those in shared libraries, also
/// for calls from the C++ library.  Without a Schedule the real functions are called, except that no
/// thread changes its scheduling class.

#include <dlfcn.h>
#include <linux/futex.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/timex.h>

#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstring>
#include <random>

#include "tests/simulation/host.hpp"
#include "tests/simulation/real_calls.hpp"
#include "tests/simulation/schedule.hpp"

namespace a351::simulation {
namespace {

template <class Function>
void find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

RealCalls find_all() {
    RealCalls calls{};
    find(calls.create, "pthread_create");
    find(calls.join, "pthread_join");
    find(calls.lock, "pthread_mutex_lock");
    find(calls.try_lock, "pthread_mutex_trylock");
    find(calls.unlock, "pthread_mutex_unlock");
    find(calls.wait, "pthread_cond_wait");
    find(calls.timed_wait, "pthread_cond_timedwait");
    find(calls.clock_wait, "pthread_cond_clockwait");
    find(calls.signal, "pthread_cond_signal");
    find(calls.broadcast, "pthread_cond_broadcast");
    find(calls.get_time, "clock_gettime");
    find(calls.sleep, "nanosleep");
    find(calls.clock_sleep, "clock_nanosleep");
    find(calls.adjust, "adjtimex");
    find(calls.lock_file, "flock");
    find(calls.system_call, "syscall");
    find(calls.open, "fopen");
    return calls;
}

Nanoseconds span_of(const timespec& time) {
    return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec);
}

void put(Nanoseconds span, timespec& time) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(span);
    time = {seconds.count(), (span - seconds).count()};
}

int lock(Schedule& schedule, pthread_mutex_t* mutex) {
    int error = EBUSY;
    while ((error = real().try_lock(mutex)) == EBUSY) schedule.wait(mutex, std::nullopt);
    if (error == 0) schedule.note_locked(mutex);
    return error;
}

int wait(Schedule& schedule, pthread_cond_t* condition, pthread_mutex_t* mutex,
         std::optional<Nanoseconds> end) {
    real().unlock(mutex);
    schedule.note_unlocked(mutex);
    const bool is_notified = schedule.wait(condition, end);
    if (const int error = lock(schedule, mutex)) return error;
    return is_notified ? 0 : ETIMEDOUT;
}

/// The futex operations of the C++ library: waiting for a future or an atomic, and waking.
long futex(Schedule& schedule, Host& host, std::uint32_t* word, int operation, std::uint32_t value,
           const timespec* time) {
    const int command = operation & FUTEX_CMD_MASK;
    if (command == FUTEX_WAKE || command == FUTEX_WAKE_BITSET) {
        schedule.notify(word, true);
        return 1;
    }
    if (__atomic_load_n(word, __ATOMIC_SEQ_CST) != value) {
        errno = EAGAIN;
        return -1;
    }
    std::optional<Nanoseconds> end;
    if (time != nullptr && command == FUTEX_WAIT) end = schedule.now() + span_of(*time);
    if (time != nullptr && command == FUTEX_WAIT_BITSET) {
        const bool is_real = (operation & FUTEX_CLOCK_REALTIME) != 0;
        end = host.schedule_time(is_real ? CLOCK_REALTIME : CLOCK_MONOTONIC, span_of(*time));
    }
    if (schedule.wait(word, end)) return 0;
    errno = ETIMEDOUT;
    return -1;
}

}  // namespace

const RealCalls& real() noexcept {
    static const RealCalls calls = find_all();
    return calls;
}

}  // namespace a351::simulation

// NOLINTBEGIN(readability-identifier-naming): names of the C library.
using namespace a351;
using namespace a351::simulation;

extern "C" {

int pthread_create(pthread_t* handle, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) noexcept {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().create(handle, attributes, body, argument);
    schedule->start(handle, body, argument);
    return 0;
}

int pthread_join(pthread_t handle, void** result) {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().join(handle, result);
    schedule->wait_for_end(handle);
    return 0;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().lock(mutex);
    schedule->yield();
    return lock(*schedule, mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
    const int error = real().try_lock(mutex);
    if (Schedule* const schedule = Schedule::mine(); schedule != nullptr && error == 0)
        schedule->note_locked(mutex);
    return error;
}

int pthread_mutex_unlock(pthread_mutex_t* mutex) noexcept {
    const int error = real().unlock(mutex);
    if (Schedule* const schedule = Schedule::mine()) {
        schedule->note_unlocked(mutex);
        schedule->yield();
    }
    return error;
}

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().wait(condition, mutex);
    return wait(*schedule, condition, mutex, std::nullopt);
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* time) {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().timed_wait(condition, mutex, time);
    return wait(*schedule, condition, mutex,
                Host::mine()->schedule_time(CLOCK_REALTIME, span_of(*time)));
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* time) {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().clock_wait(condition, mutex, clock, time);
    return wait(*schedule, condition, mutex, Host::mine()->schedule_time(clock, span_of(*time)));
}

int pthread_cond_signal(pthread_cond_t* condition) noexcept {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().signal(condition);
    schedule->notify(condition, false);
    return 0;
}

int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().broadcast(condition);
    schedule->notify(condition, true);
    return 0;
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    Host* const host = Host::mine();
    if (host == nullptr) return real().get_time(clock, time);
    put(host->read(clock), *time);
    return 0;
}

int nanosleep(const timespec* span, timespec* left) {
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr) return real().sleep(span, left);
    schedule->sleep_until(schedule->now() + span_of(*span));
    return 0;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
    Host* const host = Host::mine();
    if (host == nullptr) return real().clock_sleep(clock, flags, time, left);
    Schedule& schedule = *Schedule::mine();
    const Nanoseconds span = span_of(*time);
    schedule.sleep_until((flags & TIMER_ABSTIME) != 0 ? host->schedule_time(clock, span)
                                                      : schedule.now() + span);
    return 0;
}

int adjtimex(timex* state) noexcept {
    Host* const host = Host::mine();
    if (host == nullptr) return real().adjust(state);
    *state = {};
    if (!host->is_synchronised()) {
        state->maxerror = state->esterror = 16'000'000;  // Microseconds, the kernel's bound.
        state->status = STA_UNSYNC;
        return TIME_ERROR;
    }
    state->maxerror = state->esterror = 1000;
    return TIME_OK;
}

int flock(int descriptor, int operation) noexcept {
    const int error = real().lock_file(descriptor, operation);
    if (Host* const host = Host::mine(); host != nullptr && error == 0) host->note_lock(descriptor);
    return error;
}

/// Scheduling classes would slow down the whole simulation.
int sched_setscheduler(pid_t, int, const sched_param*) noexcept { return 0; }
int pthread_setschedparam(pthread_t, int, const sched_param*) noexcept { return 0; }

std::FILE* fopen(const char* name, const char* mode) {
    if (Host* const host = Host::mine();
        host != nullptr && std::strcmp(name, "/proc/sys/kernel/random/boot_id") == 0)
        name = host->boot_id_file().c_str();
    return real().open(name, mode);
}
std::FILE* fopen64(const char* name, const char* mode) { return fopen(name, mode); }

long syscall(long number, ...) noexcept {
    va_list arguments;
    va_start(arguments, number);
    long a[6];
    for (long& argument : a) argument = va_arg(arguments, long);
    va_end(arguments);
    Schedule* const schedule = Schedule::mine();
    if (schedule == nullptr || number != SYS_futex)
        return real().system_call(number, a[0], a[1], a[2], a[3], a[4], a[5]);
    return futex(*schedule, *Host::mine(), reinterpret_cast<std::uint32_t*>(a[0]),
                 static_cast<int>(a[1]), static_cast<std::uint32_t>(a[2]),
                 reinterpret_cast<const timespec*>(a[3]));
}

}  // extern "C"

/// Session identifiers are drawn from the seed.
std::random_device::result_type std::random_device::_M_getval() {
    Host* const host = Host::mine();
    return host == nullptr ? 0 : host->random();
}
// NOLINTEND(readability-identifier-naming)
