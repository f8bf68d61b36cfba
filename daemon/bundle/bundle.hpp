#pragma once
/// @file
/// A survey day as one tar file, made piece by piece while the daemon records.
///
///     Bundle bundle(contents_of(day));
///     const std::uint64_t size = bundle.open();
///     for (std::string piece = bundle.next(); !piece.empty(); piece = bundle.next()) send(piece);
///
/// All files are in one folder, whose SHA256SUMS comes last: it is made while the others are read.
/// Journal and archive hardly compress, so the bundle does not.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/sha256.hpp"

namespace a351::daemon::bundle {

/// File with the checksums of all others, in the form of sha256sum.
inline constexpr const char* kChecksums = "SHA256SUMS";

/// A file whose content is in memory.
struct TextFile {
    std::string name, content;
};

/// Content of a bundle.
struct Contents {
    std::string folder;          ///< Folder of all files.
    std::filesystem::path root;  ///< Data root.
    UtcTime from;                ///< The recorded files begin here, see recorded_files().
    std::vector<TextFile> texts = {};
    std::chrono::sys_seconds now{};  ///< Time of the texts.
};

/// One thread at a time.
class Bundle {
public:
    explicit Bundle(Contents contents) : contents_(std::move(contents)) {}
    // The entries refer to this object.
    Bundle(const Bundle&) = delete;
    Bundle& operator=(const Bundle&) = delete;

    /// Finds what is to be packed.  Call it once.
    /// @return the size of the tar file, bytes.
    /// @throws std::system_error  a recorded file cannot be read or synced.
    [[nodiscard]] std::uint64_t open();

    /// Returns the next bytes of the tar file, about 256 KiB; empty at its end.
    /// @throws std::system_error  a recorded file cannot be read.
    [[nodiscard]] std::string next();

private:
    struct Entry {
        std::string name;  ///< Within the folder.
        std::uint64_t size = 0;
        std::chrono::sys_seconds time;
        std::function<std::string(std::uint64_t offset, std::uint64_t count)> read;
    };
    void add(TextFile file);

    Contents contents_;
    std::vector<Entry> entries_;
    std::size_t entry_ = 0;     ///< The one that is read.
    std::uint64_t offset_ = 0;  ///< Bytes of it that were read.
    bool is_over_ = false;
    text::Sha256 digest_;
    std::string sums_;  ///< Content of kChecksums so far.
};

}  // namespace a351::daemon::bundle
