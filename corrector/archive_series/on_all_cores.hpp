#pragma once
/// @file
/// Independent calls on all cores.
///
///     std::vector<double> means(records.size());
///     on_all_cores(records.size(), [&](std::size_t i) { means[i] = mean_of(records[i]); });
///
/// Each call must write to its own element only.  The result is then the same on any number of
/// cores, because no sum depends on the order.

#include <cstddef>
#include <functional>

namespace a351::corrector::archive_series {

/// Called after each piece of work with the number of pieces done and of all pieces.  Calls come
/// from any thread, but never from two at once.  Must not throw.
///
/// `done` increases by 1 from call to call, up to `total`.  A piece that failed counts as done.  An
/// exception can end the program.  The call should be short, because other threads wait for it.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Calls work(0) ... work(count - 1), each once, from as many threads as there are cores.
///
/// The calling thread is one of them; with one core or one call there is no other.  Returns after
/// all calls are done.  Calls begin in order of their number, but run at the same time and end in
/// any order.  A failed call does not stop the others.
///
/// @param count     number of calls; with 0 nothing is called.
/// @param work      may be called from several threads at once.  It must not be empty.
/// @param progress  must not be empty; the default does nothing.
/// @throws  the exception of the failing call with the lowest number, after all calls are done.
/// @throws std::system_error  a thread could not be started.  Threads that did start have done all
///                            calls then; without any, no call is done.
void on_all_cores(
    std::size_t count, const std::function<void(std::size_t)>& work,
    const Progress& progress = [](std::size_t, std::size_t) {});

}  // namespace a351::corrector::archive_series
