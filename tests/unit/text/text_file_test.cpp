#include "protocol/text/text_file.hpp"

#include <sys/stat.h>

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::text;

TEST_CASE("the blocks of a file make up its content, and none is longer than a fixed size") {
    const test::TemporaryDirectory folder;
    for (const std::size_t size : {0U, 1U, 65536U, 65537U, 1'000'000U}) {
        std::string content(size, '\0');
        for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 7919 >> 3);
        const auto file = folder.write("f", content);
        std::string joined;
        std::size_t longest = 0;
        read_file_in_blocks(file, [&](std::string_view block) {
            joined += block;
            longest = std::max(longest, block.size());
        });
        CHECK((joined == content));
        CHECK(longest <= 65536);
        CHECK((read_text_file(file) == content));
    }
}

TEST_CASE("a FIFO is refused without waiting for it") {
    const test::TemporaryDirectory folder;
    const auto fifo = folder.path() / "fifo";
    REQUIRE(::mkfifo(fifo.c_str(), S_IRUSR | S_IWUSR) == 0);
    CHECK_THROWS_WITH(read_text_file(fifo),
                      ContainsSubstring("fifo: is not a regular file; allowed"));
    CHECK_THROWS_AS(open_file(folder.path()), InputError);
    CHECK_THROWS_WITH(open_file(folder.path() / "none"), ContainsSubstring("none: cannot be read"));
}
