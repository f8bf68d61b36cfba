#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace a351::files {

/// A link is in place of a recorded file or of a folder.  The text has no text of the operating
/// system, which would be that of another error.
class LinkRefused : public std::system_error {
public:
    explicit LinkRefused(const std::filesystem::path& link)
        : std::system_error(ELOOP, std::generic_category()),
          text_(link.string() + " is a link; links in a data root are not followed") {}

    [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

private:
    std::string text_;
};

}  // namespace a351::files
