#pragma once
/// @file
/// on_all_cores() and Progress under the name of this room, for the rooms that build on readings.

#include "corrector/archive_series/on_all_cores.hpp"

namespace a351::corrector::reading {

using archive_series::on_all_cores;
using archive_series::Progress;

}  // namespace a351::corrector::reading
