#pragma once
/// @file
/// The threads of a simulated host, run one at a time in an order drawn from a seed, in simulated
/// time.
///
/// A thread is a context with a stack of its own in the one thread of the process, because the
/// kernel needs far longer than that for a turn.  The calls that start threads, their mutexes,
/// condition variables, sleeps and clocks come here from the functions of the C library that
/// interposed.cpp replaces, so the program under test is compiled as it is.  It has no thread_local
/// variables, which would be common to all threads here.  A thread can lose its turn at each of
/// these calls and at each disk operation; code between two of them runs in one piece.  Simulated
/// time passes only while no thread can run, and by a little at each reading of a clock.  Two runs
/// with the same seed take the same turns.

#include <pthread.h>
#include <ucontext.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"

namespace a351::simulation {

class Schedule {
public:
    /// Makes the calling thread the first one.  There is at most one Schedule in a process.  Threads
    /// that were started before it must not call what interposed.cpp replaces.
    explicit Schedule(std::uint64_t seed);
    Schedule(const Schedule&) = delete;
    Schedule& operator=(const Schedule&) = delete;
    ~Schedule();

    /// Returns the schedule of this process; null if there is none.
    [[nodiscard]] static Schedule* mine() noexcept;

    /// Returns the simulated time since the first turn.  It stops while the host sleeps.
    [[nodiscard]] Nanoseconds now() const noexcept { return now_; }
    /// Returns the same, and lets a little time pass, so that a loop on a clock ends.
    [[nodiscard]] Nanoseconds read_clock() noexcept { return now_ += kClockReading; }

    /// Lets another thread run, now and then.
    void yield();

    /// Waits until notify() names `on`, or until `end`.  @return false if it was the time.
    bool wait(const void* on, std::optional<Nanoseconds> end);
    void sleep_until(Nanoseconds end) { wait(nullptr, end); }
    /// Lets all threads that wait for `on` run, or one of them.
    void notify(const void* on, bool is_for_all);

    // Threads.
    using Body = void* (*)(void*);
    void start(pthread_t* handle, Body body, void* argument);
    /// Waits until a thread has ended.
    void wait_for_end(pthread_t handle);

    // Locks, so that those of removed threads can be released.
    void note_locked(pthread_mutex_t* mutex);
    void note_unlocked(pthread_mutex_t* mutex);

    /// Gives the threads that the calling thread starts from now on to a new program.
    /// @return its number.
    int begin_program() { return program_of_children_ = ++programs_; }
    /// Removes the threads of a program in the middle of their work, as a kill does.  Their memory
    /// is never freed.  Mutexes that they hold are released.
    void kill_program(int program);

    /// Returns the number of turns, and a digest of who took them when.
    [[nodiscard]] std::uint64_t turns() const noexcept { return turns_; }
    [[nodiscard]] std::uint64_t digest() const noexcept { return digest_; }

    /// Called when no thread can ever run again.  It must not return.
    std::function<void(const std::string&)> stuck;

private:
    static constexpr Nanoseconds kClockReading{50};

    /// Knowledge of the C++ library about a thread's exceptions, see __cxa_get_globals in its ABI.
    struct Exceptions {
        void* caught = nullptr;
        unsigned int uncaught = 0;
    };
    struct Thread {
        int number = 0;
        int program = 0;
        ucontext_t context{};
        std::byte* stack = nullptr;
        Exceptions exceptions;
        Body body = nullptr;
        void* argument = nullptr;
        bool is_blocked = false, has_ended = false, is_late = false;
        const void* waits_on = nullptr;
        std::optional<Nanoseconds> end;
        std::vector<pthread_mutex_t*> held;
    };
    static void run();

    [[nodiscard]] std::byte* new_stack();
    [[nodiscard]] Thread& next();
    void pass_turn(Thread& to);
    void draw_patience();

    sim::noise::RandomStream random_;
    double mean_patience_;  ///< Mean number of calls before a thread loses its turn.
    int patience_ = 0;
    Nanoseconds now_{0};
    std::vector<std::unique_ptr<Thread>> threads_;
    std::vector<Thread*> alive_;
    Thread* self_ = nullptr;               ///< The thread that has the turn.
    std::vector<std::byte*> free_stacks_;  ///< Those of threads that ended.
    int programs_ = 0, program_of_children_ = 0;
    std::uint64_t turns_ = 0, digest_ = 0;
};

}  // namespace a351::simulation
