#pragma once

#include <pthread.h>
#include <sys/timex.h>

#include <cstdio>
#include <ctime>

namespace a351::simulation {

/// The functions of the C library that interposed.cpp replaces.
struct RealCalls {
    int (*create)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    int (*join)(pthread_t, void**);
    int (*lock)(pthread_mutex_t*);
    int (*try_lock)(pthread_mutex_t*);
    int (*unlock)(pthread_mutex_t*);
    int (*wait)(pthread_cond_t*, pthread_mutex_t*);
    int (*timed_wait)(pthread_cond_t*, pthread_mutex_t*, const timespec*);
    int (*clock_wait)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
    int (*signal)(pthread_cond_t*);
    int (*broadcast)(pthread_cond_t*);
    int (*get_time)(clockid_t, timespec*);
    int (*sleep)(const timespec*, timespec*);
    int (*clock_sleep)(clockid_t, int, const timespec*, timespec*);
    int (*adjust)(timex*);
    int (*lock_file)(int, int);
    long (*system_call)(long, ...);
    std::FILE* (*open)(const char*, const char*);
};

[[nodiscard]] const RealCalls& real() noexcept;

}  // namespace a351::simulation
