#pragma once
/// @file
/// Checks of invariants, also in release builds.
///
/// A check is for a law that follows from the code alone.  Input, files, the host's clocks and the
/// operating system must not be able to break it; for these there are values and exceptions.  After
/// a broken law nothing in memory can be trusted, so the program ends.  Its files are as after a
/// crash, which the next start repairs.
///
///     require_invariant(advance > 0, "a sample has a larger index than the one before");

#include <cstdio>
#include <cstdlib>
#include <source_location>

namespace a351 {

/// Writes one line to standard error and ends the program by abort().
[[noreturn, gnu::cold]] inline void end_by_broken_invariant(
    const char* law, const std::source_location& where) noexcept {
    std::fprintf(stderr, "a351: internal error, please report it: not true that %s (%s:%u)\n", law,
                 where.file_name(), static_cast<unsigned>(where.line()));
    std::abort();
}

/// Ends the program unless a law holds.
/// @param law  the law as a clause in plain words; a literal.
inline void require_invariant(
    bool holds, const char* law,
    const std::source_location& where = std::source_location::current()) noexcept {
    if (!holds) [[unlikely]]
        end_by_broken_invariant(law, where);
}

}  // namespace a351
