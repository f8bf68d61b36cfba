/// @file
/// Sifting allocates nothing.  A program of its own, for it replaces operator new.

#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "tests/unit/eemd/series.hpp"

namespace {

bool counting = false;
int allocations = 0;

void* allocate(std::size_t size) {
    if (counting) ++allocations;
    void* const memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace a351::corrector {

TEST_CASE("a workspace sifts record after record without allocating") {
    EmdWorkspace emd(1000);
    SiftOptions options;
    for (const EndRule ends : {EndRule::line, EndRule::mirror}) {
        options.ends = ends;
        const std::vector<double> signal = mixed_series(1000);
        counting = true;
        std::copy(signal.begin(), signal.end(), emd.residue().begin());
        int modes = 0;
        while (!emd.next_mode(options).empty()) ++modes;
        counting = false;
        CHECK(modes > 5);
    }
    CHECK(allocations == 0);
}

}  // namespace a351::corrector
