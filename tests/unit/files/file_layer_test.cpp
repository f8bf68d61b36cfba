#include "protocol/files/file_layer.hpp"

#include <system_error>
#include <vector>
#include "tests/support/catch.hpp"

#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/files/failing_files.hpp"

namespace a351::files {
namespace {

using test::bytes_of;

std::string text_in(const std::filesystem::path& file) {
    const auto bytes = test::read_bytes(file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

TEST_CASE("appending continues at the end of the file, and truncating keeps its beginning") {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "log";
    for (const char* text : {"one ", "two ", "three"}) {
        const auto file = posix_files().open_append(path);
        file->append(bytes_of(text));
        file->sync();
        CHECK(file->size() == std::filesystem::file_size(path));
    }
    CHECK(text_in(path) == "one two three");
    posix_files().truncate(path, 4);
    CHECK(text_in(path) == "one ");
}

TEST_CASE("the work of a disk is counted in whole blocks at each sync") {
    const test::TemporaryDirectory directory;
    const auto files = files_below(directory.path());
    const auto has_done = [&](std::uint64_t bytes, std::uint64_t syncs) {
        const DiskWork work = files->work();
        UNSCOPED_INFO(work.bytes << " bytes, " << work.syncs << " syncs");
        return work.bytes == bytes && work.syncs == syncs;
    };
    const auto path = directory.path() / "log";
    {
        const auto file = files->open_append(path);
        file->append(std::vector<std::byte>(5000));
        CHECK(has_done(0, 0));
        file->sync();
        CHECK(has_done(8192, 1));
        file->append(std::vector<std::byte>(10));  // The second block again.
        file->sync();
        CHECK(has_done(12288, 2));
        file->sync();
        CHECK(has_done(12288, 3));
    }
    files->sync_directory(directory.path());
    CHECK(has_done(16384, 4));
    const auto again = files->open_append(path);  // Its bytes were written before.
    again->append(std::vector<std::byte>(4096));
    again->sync();
    CHECK(has_done(24576, 5));
}

TEST_CASE("a failure names operation and path") {
    const test::TemporaryDirectory directory;
    const auto absent = directory.path() / "absent" / "file";
    const auto names = ContainsSubstring("absent/file");
    auto& files = posix_files();
    CHECK_THROWS_WITH(files.open_append(absent), ContainsSubstring("open") && names);
    CHECK_THROWS_WITH(files.truncate(absent, 0), names);
    CHECK_THROWS_WITH(files.rename(absent, directory.path() / "x"),
                      ContainsSubstring("rename") && names);
    CHECK_THROWS_WITH(files.remove(absent), ContainsSubstring("remove") && names);
    CHECK_THROWS_AS(files.sync_directory(absent), std::system_error);
}

constexpr const char* kLinkRefused = " is a link; links in a data root are not followed";

TEST_CASE("a link in place of a file is not followed, and a new file takes no existing name") {
    const test::TemporaryDirectory directory;
    const auto victim = directory.path() / "victim", link = directory.path() / "log";
    for (const bool exists : {true, false}) {
        if (exists) test::write_bytes(victim, bytes_of("secret"));
        if (!exists) std::filesystem::remove(victim);
        std::filesystem::remove(link);
        std::filesystem::create_symlink(victim, link);
        auto& files = posix_files();
        CHECK_THROWS_WITH(files.open_append(link), std::string(link) + kLinkRefused);
        CHECK_THROWS_AS(files.truncate(link, 0), std::system_error);
        CHECK_THROWS_AS(files.allocate(link, 4096), std::system_error);
        CHECK_THROWS_AS(files.create(link), std::system_error);
        // A link in place of the temporary file is removed, and the file itself is replaced.
        std::filesystem::create_symlink(victim, directory.path() / "table.tmp");
        replace_file(files, directory.path() / "table", bytes_of("new"));
        CHECK(text_in(directory.path() / "table") == "new");
        CHECK_FALSE(std::filesystem::is_symlink(directory.path() / "table"));
        CHECK(std::filesystem::exists(victim) == exists);
        if (exists) CHECK(text_in(victim) == "secret");
    }
    posix_files().create(directory.path() / "new")->append(bytes_of("first"));
    CHECK_THROWS_AS(posix_files().create(directory.path() / "new"), std::system_error);
    CHECK(text_in(directory.path() / "new") == "first");
}

TEST_CASE("a link in place of a folder below the root is not followed") {
    const test::TemporaryDirectory directory;
    const auto victim = directory.path() / "victim", root = directory.path() / "data";
    std::filesystem::create_directory(victim);
    test::write_bytes(victim / "log", bytes_of("secret"));
    std::filesystem::create_directory(directory.path() / "disk");
    std::filesystem::create_symlink("disk", root);  // The root itself may be a link.
    const auto files = files_below(root);
    files->create_directories(root / "archive" / "2026");
    files->sync_directory(root);
    CHECK(std::filesystem::is_directory(directory.path() / "disk" / "archive" / "2026"));
    CHECK_NOTHROW(files->create_directories(root / "archive" / "2026" / ""));
    for (const auto& folder : {root / "events", root / "archive" / "2026" / "XX"}) {
        std::filesystem::create_directory_symlink(victim, folder);
        CHECK_THROWS_WITH(files->open_append(folder / "log"), std::string(folder) + kLinkRefused);
        CHECK_THROWS_AS(files->create(folder / "new"), std::system_error);
        CHECK_THROWS_AS(files->truncate(folder / "log", 0), std::system_error);
        CHECK_THROWS_AS(files->allocate(folder / "new", 4096), std::system_error);
        CHECK_THROWS_AS(files->remove(folder / "log"), std::system_error);
        CHECK_THROWS_WITH(files->sync_directory(folder), std::string(folder) + kLinkRefused);
        CHECK_THROWS_AS(files->create_directories(folder / "new"), std::system_error);
        test::write_bytes(root / "own", bytes_of("own"));
        CHECK_THROWS_AS(files->rename(root / "own", folder / "log"), std::system_error);
        CHECK_THROWS_AS(files->rename(folder / "log", root / "own"), std::system_error);
    }
    CHECK(text_in(victim / "log") == "secret");
    CHECK_FALSE(std::filesystem::exists(victim / "new"));
    replace_file(*files, root / "archive" / "table", bytes_of("new"));
    CHECK(text_in(root / "archive" / "table") == "new");
    // A path elsewhere, and any path of posix_files(), follows links.
    std::filesystem::create_directory_symlink(victim, directory.path() / "elsewhere");
    CHECK(files->open_append(directory.path() / "elsewhere" / "log")->size() == 6);
    CHECK(posix_files().open_append(root / "events" / "log")->size() == 6);
}

TEST_CASE("appending to a full disk is an error") {
    if (!std::filesystem::exists("/dev/full")) {
        WARN("skipped: this system has no /dev/full");
        return;
    }
    const auto file = posix_files().open_append("/dev/full");
    CHECK_THROWS_WITH(file->append(bytes_of("x")), ContainsSubstring("append to /dev/full"));
}

TEST_CASE("a replaced file holds the old or the new content, whichever operation fails") {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "state.json";
    bool is_done = false;
    for (int fail_at = 1; !is_done; ++fail_at) {
        replace_file(posix_files(), path, bytes_of("old"));
        test::FailingFiles files(fail_at);
        try {
            replace_file(files, path, bytes_of("new content"));
            is_done = true;
            CHECK(text_in(path) == "new content");
            CHECK(fail_at > 5);
        } catch (const std::system_error&) {
            const auto text = text_in(path);
            CHECK((text == "old" || text == "new content"));
        }
        // Remains of a failed attempt do not disturb the next one.
        replace_file(posix_files(), path, bytes_of("newer"));
        CHECK(text_in(path) == "newer");
    }
}

}  // namespace a351::files
