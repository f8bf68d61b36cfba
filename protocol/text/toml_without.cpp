#include "protocol/text/toml_without.hpp"

#include <toml++/toml.h>

#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {

std::string toml_without(const std::filesystem::path& file, std::string_view table,
                         std::string_view key) try {
    toml::table document = toml::parse(read_text_file(file), file.string());
    if (auto* const part = document[table].as_table()) part->erase(key);
    std::ostringstream out;
    out << document << '\n';
    return out.str();
} catch (const toml::parse_error& error) {
    throw InputError(file.string() + ": " + error.what());
}

}  // namespace a351::text
