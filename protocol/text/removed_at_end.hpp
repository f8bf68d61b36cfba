#pragma once
/// @file
/// A file or a folder that is removed at the end of a scope, also after an exception.
///
///     const RemovedAtEnd candidate(file.string() + ".candidate");
///     write_together(folder, {{candidate.path().filename().string(), text}});

#include <filesystem>
#include <system_error>
#include <utility>

namespace a351::text {

/// Removes a path and its content at the end of its life.  A path that does not exist then, or
/// cannot be removed, is no error.
class RemovedAtEnd {
public:
    explicit RemovedAtEnd(std::filesystem::path path) : path_(std::move(path)) {}
    RemovedAtEnd(const RemovedAtEnd&) = delete;
    RemovedAtEnd& operator=(const RemovedAtEnd&) = delete;
    ~RemovedAtEnd() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace a351::text
