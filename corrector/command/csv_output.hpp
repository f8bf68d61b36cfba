#pragma once

#include <string>

namespace a351::corrector {

/// Writes the table to a new or replaced file; to standard output if `file` is empty.
/// @throws std::system_error  the file cannot be written; nothing is left of it.
void write_or_print(const std::string& file, std::string csv);

}  // namespace a351::corrector
