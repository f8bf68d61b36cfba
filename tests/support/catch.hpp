#pragma once
/// @file
/// Catch2 with the names of version 3 (Debian 13), also if version 2 is installed (Debian 12).

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;  // Version 2 declares it globally itself.
using Catch::Matchers::ContainsSubstring;
#else
#include <catch2/catch.hpp>
/// Returns the matcher that version 2 calls Contains.
[[nodiscard]] inline auto ContainsSubstring(const std::string& part) {
    return Catch::Matchers::Contains(part);
}
#endif

// The name Contains searches a text in version 2, and an element of a list in version 3.
#pragma GCC poison Contains

using Catch::Matchers::EndsWith;
using Catch::Matchers::Message;
using Catch::Matchers::StartsWith;
