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

namespace a351 {

/// Writes one line to standard error and ends the program by abort().
[[noreturn, gnu::cold]] inline void end_by_broken_invariant(const char* law, const char* file,
                                                            int line) noexcept {
    std::fprintf(stderr, "a351: internal error, please report it: not true that %s (%s:%d)\n", law,
                 file, line);
    std::abort();
}

/// Ends the program unless a law holds.
/// @param law  the law as a clause in plain words; a literal.
/// @param file, line  place of the caller.  They are not a std::source_location, which clang 14 does not
///                    have with the library of GCC 12.
inline void require_invariant(bool holds, const char* law, const char* file = __builtin_FILE(),
                              int line = __builtin_LINE()) noexcept {
    if (!holds) [[unlikely]]
        end_by_broken_invariant(law, file, line);
}

}  // namespace a351
