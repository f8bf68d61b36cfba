#include "protocol/files/file_layer.hpp"

#include <system_error>
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

TEST_CASE("appending continues at the end of the file", "[record][file_layer]") {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "log";
    for (const char* text : {"one ", "two ", "three"}) {
        const auto file = posix_files().open_append(path);
        file->append(bytes_of(text));
        file->sync();
        CHECK(file->size() == std::filesystem::file_size(path));
    }
    CHECK(text_in(path) == "one two three");
}

TEST_CASE("directories are made together with all missing parents", "[record][file_layer]") {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "a" / "b" / "c";
    posix_files().create_directories(path);
    CHECK(std::filesystem::is_directory(path));
    CHECK_NOTHROW(posix_files().create_directories(path / ""));
}

TEST_CASE("a failure names operation and path", "[record][file_layer]") {
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

TEST_CASE("a link in place of a file is not followed", "[record][file_layer]") {
    const test::TemporaryDirectory directory;
    const auto victim = directory.path() / "victim", link = directory.path() / "log";
    for (const bool exists : {true, false}) {
        if (exists) test::write_bytes(victim, bytes_of("secret"));
        if (!exists) std::filesystem::remove(victim);
        std::filesystem::remove(link);
        std::filesystem::create_symlink(victim, link);
        auto& files = posix_files();
        CHECK_THROWS_WITH(files.open_append(link), ContainsSubstring("without following a link"));
        CHECK_THROWS_AS(files.truncate(link, 0), std::system_error);
        CHECK_THROWS_AS(files.allocate(link, 4096), std::system_error);
        // A link in place of the temporary file is removed, and the file itself is replaced.
        std::filesystem::create_symlink(victim, directory.path() / "table.tmp");
        replace_file(files, directory.path() / "table", bytes_of("new"));
        CHECK(text_in(directory.path() / "table") == "new");
        CHECK_FALSE(std::filesystem::is_symlink(directory.path() / "table"));
        CHECK(std::filesystem::exists(victim) == exists);
        if (exists) CHECK(text_in(victim) == "secret");
    }
}

TEST_CASE("appending to a full disk is an error", "[record][file_layer]") {
    if (!std::filesystem::exists("/dev/full")) {
        WARN("skipped: this system has no /dev/full");
        return;
    }
    const auto file = posix_files().open_append("/dev/full");
    CHECK_THROWS_WITH(file->append(bytes_of("x")), ContainsSubstring("append to /dev/full"));
}

TEST_CASE("truncate keeps the beginning of the file", "[record][file_layer]") {
    const test::TemporaryDirectory directory;
    const auto path = directory.path() / "file";
    test::write_bytes(path, bytes_of("0123456789"));
    posix_files().truncate(path, 4);
    CHECK(text_in(path) == "0123");
}

TEST_CASE("a replaced file holds the old or the new content, whichever operation fails",
          "[record][file_layer]") {
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
