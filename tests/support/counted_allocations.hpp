#pragma once
/// @file
/// Counts the allocations of one thread by operator new.  Not counted: malloc(), which allocates
/// Eigen's matrices, and over-aligned new.  Replaces the global operator, so include it in one file
/// of a separate program only.

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace a351::test {

inline std::atomic<pid_t> watched_thread{0};  ///< Thread whose allocations are counted; 0: none.
inline std::atomic<int> allocations{0};

inline void* allocate(std::size_t size, const std::nothrow_t&) noexcept {
    if (watched_thread != 0 && gettid() == watched_thread) ++allocations;
    return std::malloc(size == 0 ? 1 : size);
}

inline void* allocate(std::size_t size) {
    void* const memory = allocate(size, std::nothrow);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

/// Not inlined, because g++ would then warn that memory from operator new is released by free().
[[gnu::noinline]] inline void release(void* memory) noexcept { std::free(memory); }

}  // namespace a351::test

void* operator new(std::size_t size) { return a351::test::allocate(size); }
void* operator new[](std::size_t size) { return a351::test::allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t& tag) noexcept {
    return a351::test::allocate(size, tag);
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
    return a351::test::allocate(size, tag);
}
void operator delete(void* memory) noexcept { a351::test::release(memory); }
void operator delete[](void* memory) noexcept { a351::test::release(memory); }
void operator delete(void* memory, std::size_t) noexcept { a351::test::release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { a351::test::release(memory); }
