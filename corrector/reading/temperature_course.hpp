#pragma once
/// @file
/// MinuteTemperature under the name of this room, for the rooms that show a survey.

#include "corrector/archive_series/temperature_course.hpp"

namespace a351::corrector::reading {

using archive_series::MinuteTemperature;

}  // namespace a351::corrector::reading
