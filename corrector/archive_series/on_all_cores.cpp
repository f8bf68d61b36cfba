#include "corrector/archive_series/on_all_cores.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace a351::corrector::archive_series {

void on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work,
                  const Progress& progress) {
    std::vector<std::exception_ptr> errors(count);
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::size_t done = 0;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                errors[i] = std::current_exception();
            }
            const std::lock_guard lock(mutex);
            progress(++done, count);
        }
    };
    {
        const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
        std::vector<std::jthread> threads;
        for (std::size_t k = 1; k < std::min(cores, count); ++k) threads.emplace_back(run);
        run();
    }
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace a351::corrector::archive_series
