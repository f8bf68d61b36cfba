#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "corrector/survey/result_files.hpp"

namespace a351::corrector {
namespace {

/// Removes what it was told of unless kept.
class TemporaryFiles {
public:
    TemporaryFiles() = default;
    TemporaryFiles(const TemporaryFiles&) = delete;
    TemporaryFiles& operator=(const TemporaryFiles&) = delete;
    ~TemporaryFiles() {
        std::error_code ignored;
        for (const auto& file : files_) std::filesystem::remove(file, ignored);
    }
    void add(std::filesystem::path file) { files_.push_back(std::move(file)); }

private:
    std::vector<std::filesystem::path> files_;
};

std::filesystem::path temporary_name(const std::filesystem::path& directory,
                                     const std::string& name) {
    return directory / ("." + name + "." + std::to_string(::getpid()) + ".part");
}

}  // namespace

void write_together(const std::filesystem::path& directory, const std::vector<NamedText>& files) {
    std::filesystem::create_directories(directory);
    TemporaryFiles temporaries;
    for (const auto& [name, content] : files) {
        const std::filesystem::path path = temporary_name(directory, name);
        temporaries.add(path);
        errno = 0;
        std::ofstream out(path, std::ios::binary | std::ios::trunc);
        out << content;
        out.close();
        if (!out) {
            throw std::system_error(errno == 0 ? EIO : errno, std::generic_category(),
                                    path.string() + ": cannot be written");
        }
        // A rename onto a device or a link would replace it.
        const auto type = std::filesystem::symlink_status(directory / name).type();
        if (type != std::filesystem::file_type::not_found &&
            type != std::filesystem::file_type::regular) {
            throw std::system_error(EEXIST, std::generic_category(),
                                    (directory / name).string() + ": is no regular file");
        }
    }
    for (const auto& [name, content] : files) {
        std::filesystem::rename(temporary_name(directory, name), directory / name);
    }
}

}  // namespace a351::corrector
