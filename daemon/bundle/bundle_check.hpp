#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stdexcept>

namespace a351::daemon::bundle {

/// A bundle is not as it was made.  The text is one sentence in the language of the program.
class BadBundle : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads a bundle from the disk and compares each file in it with its checksum.
/// @param progress  gets the bytes read and all bytes.
/// @return          the number of files in it.
/// @throws BadBundle, std::system_error
std::size_t check_bundle(const std::filesystem::path& file,
                         const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace a351::daemon::bundle
