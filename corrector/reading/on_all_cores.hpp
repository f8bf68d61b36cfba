#pragma once
/// @file
/// Independent calls on all cores.

#include <cstddef>
#include <functional>

namespace a351::corrector {

/// Called after each piece of work with the number of pieces done and of all pieces.  Calls come
/// from any thread, but never from two at once.  Must not throw.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Calls work(0) ... work(count - 1), each once, from as many threads as there are cores.
/// @throws  the exception of the failing call with the lowest number, after all calls are done.
void on_all_cores(
    std::size_t count, const std::function<void(std::size_t)>& work,
    const Progress& progress = [](std::size_t, std::size_t) {});

}  // namespace a351::corrector
