#pragma once

#include <cstddef>

namespace a351::corrector {

/// Decimation of a set-up's samples before anything is averaged: two stages by 10, one value for 100 samples
/// (at 50 samples/s every 2 s).
inline constexpr int kFactor = 10;
inline constexpr int kStages = 2;
inline constexpr std::size_t kRatio = 100;

}  // namespace a351::corrector
