#include "protocol/text/text_file.hpp"

#include <fstream>
#include <sstream>

#include "protocol/core/input_error.hpp"

namespace a351::text {

std::string read_text_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream content;
    if (std::filesystem::is_regular_file(file)) content << in.rdbuf();
    if (!in.is_open() || in.bad() || !std::filesystem::is_regular_file(file)) {
        throw InputError(file.string() + ": cannot be read; allowed: a readable file");
    }
    return std::move(content).str();
}

}  // namespace a351::text
