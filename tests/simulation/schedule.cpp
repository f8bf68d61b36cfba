#include "tests/simulation/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "tests/simulation/real_calls.hpp"

namespace a351::simulation {
namespace {

Schedule* only_schedule = nullptr;

}  // namespace

thread_local Schedule::Thread* Schedule::self_ = nullptr;

Schedule* Schedule::mine() noexcept { return self_ == nullptr ? nullptr : only_schedule; }

Schedule::Schedule(std::uint64_t seed)
    : random_(seed, "turns"),
      mean_patience_(std::exp(random_.uniform(std::log(2.0), std::log(200.0)))) {
    threads_.push_back(std::make_unique<Thread>());
    self_ = threads_.back().get();
    sem_init(&self_->turn, 0, 0);
    alive_.push_back(self_);
    only_schedule = this;
    draw_patience();
}

Schedule::~Schedule() {
    self_ = nullptr;
    only_schedule = nullptr;
}

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
    Thread& from = *self_;
    sem_post(&to.turn);
    if (from.has_ended) return;
    while (sem_wait(&from.turn) != 0) {
    }
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
    std::vector<Thread*> waiting;
    for (Thread* thread : alive_)
        if (thread->is_blocked && thread->waits_on == on) waiting.push_back(thread);
    if (waiting.empty()) return;
    if (!is_for_all) waiting = {waiting[random_.bits() % waiting.size()]};
    for (Thread* thread : waiting) thread->is_blocked = false;
}

int Schedule::start(pthread_t* handle, const pthread_attr_t* attributes, Body body,
                    void* argument) {
    auto& thread = *threads_.emplace_back(std::make_unique<Thread>());
    thread.number = static_cast<int>(threads_.size());
    thread.program = self_->program != 0 ? self_->program : program_of_children_;
    sem_init(&thread.turn, 0, 0);
    thread.body = body;
    thread.argument = argument;
    const int error = real().create(handle, attributes, &Schedule::run, &thread);
    if (error != 0) return error;
    thread.handle = *handle;
    alive_.push_back(&thread);
    yield();
    return 0;
}

void* Schedule::run(void* argument) {
    auto& thread = *static_cast<Thread*>(argument);
    while (sem_wait(&thread.turn) != 0) {
    }
    self_ = &thread;
    void* const result = thread.body(thread.argument);
    Schedule& schedule = *only_schedule;
    thread.has_ended = true;
    std::erase(schedule.alive_, &thread);
    schedule.notify(&thread, true);
    schedule.pass_turn(schedule.next());
    self_ = nullptr;
    return result;
}

void Schedule::wait_for_end(pthread_t handle) {
    const auto found = std::ranges::find_if(threads_, [&](const auto& thread) {
        return !thread->has_ended && pthread_equal(thread->handle, handle) != 0;
    });
    if (found == threads_.end()) return;
    const Thread* const thread = found->get();  // The list can grow meanwhile.
    while (!thread->has_ended) wait(thread, std::nullopt);
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
