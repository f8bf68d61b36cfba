#include "corrector/command/output_option.hpp"

#include <string>

#include "protocol/core/input_error.hpp"

namespace a351::corrector {
namespace {

[[noreturn]] void refuse(std::string_view name, const std::filesystem::path& path,
                         const std::string& trouble) {
    throw InputError(std::string(name) + " = " + path.string() + ": " + trouble);
}

/// Returns the longest beginning of the path that exists.
std::filesystem::path existing_part(std::filesystem::path path) {
    while (path.has_relative_path() && !std::filesystem::exists(path)) path = path.parent_path();
    return path;
}

}  // namespace

void require_file_option(std::string_view name, const std::filesystem::path& path) {
    using Type = std::filesystem::file_type;
    const Type type = std::filesystem::symlink_status(path).type();
    if (!path.has_filename() || (type != Type::not_found && type != Type::regular))
        refuse(name, path, "not a regular file; allowed: a file");
    const auto folder = existing_part(std::filesystem::absolute(path).parent_path());
    if (!std::filesystem::is_directory(folder))
        refuse(name, path, folder.string() + " is not a folder; allowed: a file in a folder");
}

void require_folder_option(std::string_view name, const std::filesystem::path& path) {
    const auto folder = existing_part(std::filesystem::absolute(path));
    if (!std::filesystem::is_directory(folder))
        refuse(name, path, folder.string() + " is not a folder; allowed: a folder");
}

}  // namespace a351::corrector
