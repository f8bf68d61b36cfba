#pragma once
/// @file
/// Result files that are complete or absent.
///
/// Use NewFile for a result that is written piece by piece, write_together() of write_together.hpp
/// for a set of short texts.
///
///     NewFile file("result/stations.csv");
///     file.write(header);
///     for (const auto& row : rows) file.write(line_of(row));
///     file.close();    // a full disk is reported here at the latest
///     file.publish();  // now the name has the new content
///
/// Nothing is synced: a reader never sees half a file, but after a power failure the content may be
/// lost.  Use files::replace_file() where it must survive.

#include <filesystem>
#include <fstream>
#include <string_view>

namespace a351::text {

/// File that appears under its name only when it is complete, and leaves nothing behind otherwise.
///
/// All members throw std::system_error with the path if the operating system reports an error.
///
/// The temporary file is `.NAME.PID.part` in the same directory, so that the rename is within one
/// file system.  It remains if the process is killed.  Different processes may write the same path,
/// and the last publish() wins.  Within a process only one object at a time may write it.  A
/// NewFile cannot be copied (tests/compile_fail/new_file_copied.cpp) or moved.
class NewFile {
public:
    /// Opens a temporary file beside `path`; the directory must exist.
    /// @param path  name of the finished file; an existing one is replaced only by publish().
    explicit NewFile(std::filesystem::path path);
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    /// Removes the temporary file, unless it was published.  The file at `path` stays as it is.
    ~NewFile();

    /// Appends the bytes as they are.  They are buffered, so an error of the disk may be thrown by
    /// a later call, at the latest by close().
    void write(std::string_view text);

    /// Completes the content.  `path` must be a regular file or must not exist.  A link or a device
    /// at `path` is an error, because a rename would replace it.
    void close();

    /// Renames the closed file to `path`.  A file of that name is replaced in one step.  Call it
    /// once, after close(): before it the content can be incomplete.
    void publish();

private:
    void require_good();

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::ofstream out_;
};

}  // namespace a351::text
