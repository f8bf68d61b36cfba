#include "tests/simulation/schedule.hpp"

#include <cxxabi.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <new>
#include <utility>

#include "tests/simulation/real_calls.hpp"

namespace a351::simulation {
namespace {

Schedule* only_schedule = nullptr;

constexpr std::size_t kStack_bytes = std::size_t{8} << 20;  // Linux's default for a thread.
constexpr std::size_t kGuard_bytes = 4096;                  // One page.

}  // namespace

Schedule* Schedule::mine() noexcept { return only_schedule; }

Schedule::Schedule(std::uint64_t seed)
    : random_(seed, "turns"),
      mean_patience_(std::exp(random_.uniform(std::log(2.0), std::log(200.0)))) {
    threads_.push_back(std::make_unique<Thread>());
    self_ = threads_.back().get();
    alive_.push_back(self_);
    only_schedule = this;
    draw_patience();
}

Schedule::~Schedule() { only_schedule = nullptr; }

void Schedule::draw_patience() {
    patience_ = static_cast<int>(mean_patience_ * random_.exponential());
}

/// Returns a thread that can run, and lets time pass until there is one.
Schedule::Thread& Schedule::next() {
    while (true) {
        std::size_t ready = 0;
        std::optional<Nanoseconds> soonest;
        for (Thread* thread : alive_) {
            if (thread->is_blocked && thread->end && *thread->end <= now_) {
                thread->is_blocked = false;
                thread->is_late = true;
            }
            if (!thread->is_blocked)
                ++ready;
            else if (thread->end)
                soonest = std::min(soonest.value_or(*thread->end), *thread->end);
        }
        if (ready > 0) {
            auto chosen = ready == 1 ? 0 : random_.bits() % ready;
            for (Thread* thread : alive_)
                if (!thread->is_blocked && chosen-- == 0) return *thread;
        }
        if (!soonest) stuck("no thread can run any more");
        now_ = std::max(now_, *soonest);
    }
}

void Schedule::pass_turn(Thread& to) {
    ++turns_;
    digest_ = (digest_ ^ static_cast<std::uint64_t>(to.number + now_.count())) *
              0x100000001B3U;  // FNV-1a.
    if (&to == self_) return;
    auto& exceptions = *reinterpret_cast<Exceptions*>(abi::__cxa_get_globals());
    Thread& from = *std::exchange(self_, &to);
    from.exceptions = std::exchange(exceptions, to.exceptions);
    const int error = errno;
    ::swapcontext(&from.context, &to.context);
    errno = error;
}

void Schedule::yield() {
    if (--patience_ > 0) return;
    draw_patience();
    pass_turn(next());
}

bool Schedule::wait(const void* on, std::optional<Nanoseconds> end) {
    Thread& thread = *self_;
    thread.is_blocked = true;
    thread.is_late = false;
    thread.waits_on = on;
    thread.end = end;
    pass_turn(next());
    thread.waits_on = nullptr;
    return !thread.is_late;
}

void Schedule::notify(const void* on, bool is_for_all) {
    const auto is_waiting = [&](const Thread* thread) {
        return thread->is_blocked && thread->waits_on == on;
    };
    const auto count = static_cast<std::uint64_t>(std::ranges::count_if(alive_, is_waiting));
    if (count == 0) return;
    const std::uint64_t chosen = is_for_all ? 0 : random_.bits() % count;
    std::uint64_t passed = 0;
    for (Thread* thread : alive_)
        if (is_waiting(thread) && (is_for_all || passed++ == chosen)) thread->is_blocked = false;
}

/// Returns a stack above a page that cannot be read or written.
std::byte* Schedule::new_stack() {
    if (!free_stacks_.empty()) {
        std::byte* const stack = free_stacks_.back();
        free_stacks_.pop_back();
        return stack;
    }
    void* const stack = ::mmap(nullptr, kStack_bytes, PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
    if (stack == MAP_FAILED || ::mprotect(stack, kGuard_bytes, PROT_NONE) != 0)
        throw std::bad_alloc();
    return static_cast<std::byte*>(stack);
}

void Schedule::start(pthread_t* handle, Body body, void* argument) {
    auto& thread = *threads_.emplace_back(std::make_unique<Thread>());
    thread.number = static_cast<int>(threads_.size());
    thread.program = self_->program != 0 ? self_->program : program_of_children_;
    thread.body = body;
    thread.argument = argument;
    thread.stack = new_stack();
    ::getcontext(&thread.context);
    thread.context.uc_stack.ss_sp = thread.stack;
    thread.context.uc_stack.ss_size = kStack_bytes;
    ::makecontext(&thread.context, &Schedule::run, 0);
    alive_.push_back(&thread);
    *handle = static_cast<pthread_t>(thread.number);
    yield();
}

/// The first and last function of a thread.
void Schedule::run() {
    Schedule& schedule = *only_schedule;
    Thread& thread = *schedule.self_;
    thread.body(thread.argument);
    thread.has_ended = true;
    std::erase(schedule.alive_, &thread);
    schedule.free_stacks_.push_back(thread.stack);  // Only another thread can take it.
    schedule.notify(&thread, true);
    schedule.pass_turn(schedule.next());
}

void Schedule::wait_for_end(pthread_t handle) {
    const Thread& thread = *threads_.at(static_cast<std::size_t>(handle) - 1);
    while (!thread.has_ended) wait(&thread, std::nullopt);
}

void Schedule::note_locked(pthread_mutex_t* mutex) { self_->held.push_back(mutex); }

void Schedule::note_unlocked(pthread_mutex_t* mutex) {
    auto& held = self_->held;
    const auto found = std::find(held.rbegin(), held.rend(), mutex);
    if (found != held.rend()) held.erase(std::next(found).base());
    notify(mutex, true);
}

void Schedule::kill_program(int program) {
    for (Thread* thread : alive_) {
        if (thread->program != program) continue;
        for (pthread_mutex_t* mutex : thread->held) {
            real().unlock(mutex);
            notify(mutex, true);
        }
    }
    std::erase_if(alive_, [&](const Thread* thread) { return thread->program == program; });
}

}  // namespace a351::simulation
