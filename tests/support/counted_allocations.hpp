#pragma once
/// @file
/// Counts what one thread allocates by operator new.  Not counted: malloc(), by which Eigen's matrices are
/// allocated, and over-aligned new.  It replaces the operator: for one file of a program of its own.

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace a351::test {

inline std::atomic<pid_t> watched_thread{0};  ///< 0: none.
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

/// Inlined, g++ sees free() meet operator new.
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
