#pragma once

#include <cstddef>
#include <functional>

namespace a351::corrector {

/// Called now and then with the number of pieces done and in all, from any thread but never from two
/// at once; does not throw.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Calls work(0) ... work(count - 1) from as many threads as there are cores.
/// @throws  what the first failing call threw, by number.
void on_all_cores(
    std::size_t count, const std::function<void(std::size_t)>& work,
    const Progress& progress = [](std::size_t, std::size_t) {});

}  // namespace a351::corrector
