#include "daemon/page/assets.hpp"

#include <fstream>
#include <iterator>
#include "daemon/config/verdict_config.hpp"
#include "protocol/text/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

namespace {

std::string body_of(const Assets& assets, const std::string& path) {
    REQUIRE(assets.contains(path));
    return assets.answer(path, true).body;
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the page knows the name of every language") {
    const Assets assets({}, "sesame");
    for (const char* path : {"/", "/boxes"}) {
        const std::string page = body_of(assets, path);
        CHECK(has(page, "&quot;en&quot;:&quot;English&quot;"));
        for (const text::Language& one : text::other_languages())
            CHECK(has(page, "&quot;" + std::string(one.code) + "&quot;:&quot;" +
                                std::string(text::name_of(one)) + "&quot;"));
        CHECK_FALSE(has(page, "@LANGUAGES@"));
    }
}

TEST_CASE(
    "the page and every file it loads are compiled in, byte for byte and with the daemon's "
    "values") {
    const Assets assets({}, "sesame");
    const auto index = assets.answer("/", true);
    CHECK(index.content_type == "text/html; charset=utf-8");
    CHECK(has(index.body, R"(<meta name="a351-token" content="sesame">)"));
    CHECK_FALSE(has(index.body, "@TOKEN@"));
    CHECK(index.body == body_of(assets, "/index.html"));
    CHECK(assets.answer("/page.js", true).content_type == "text/javascript; charset=utf-8");
    CHECK(assets.answer("/page.css", true).content_type == "text/css; charset=utf-8");
    CHECK(has(body_of(assets, "/signal.js"),
              "kStale_s = " + std::to_string(config::kStaleAfter.count()) + ";"));
    CHECK(has(body_of(Assets({}, R"("><script>&)"), "/"), R"(content="&quot;>&lt;script>&amp;")"));
    std::ifstream file("/usr/share/javascript/dygraphs/dygraph.min.js", std::ios::binary);
    REQUIRE(file);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    CHECK((body_of(assets, "/dygraph.min.js") == bytes));
    CHECK(has(body_of(assets, "/dygraph.css"), ".dygraph-"));

    // Every file that the page loads from the daemon is there.
    const auto& page = index.body;
    for (const std::string mark : {"src=\"/", "href=\"/"}) {
        for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
            const auto begin = at + mark.size() - 1;
            const auto path = page.substr(begin, page.find('"', begin) - begin);
            CAPTURE(path);
            CHECK((path == "/api/bundle" || assets.contains(path)));
        }
    }
    // Inline code and styles would be blocked by the content security policy.
    CHECK_FALSE(has(page, "<script>"));
    CHECK_FALSE(has(page, " style="));
    CHECK_FALSE(has(page, " onclick="));
}

TEST_CASE("the overview of boxes may connect to them, and no other page may") {
    const std::vector<std::string> boxes{"http://192.0.2.7:8351", "http://192.0.2.8:8351"};
    const Assets assets({}, "sesame", boxes);
    const auto overview = assets.answer("/boxes", true);
    CHECK(has(overview.body, R"(<meta name="a351-token" content="sesame">)"));
    CHECK(has(overview.body, R"(content="http://192.0.2.7:8351 http://192.0.2.8:8351")"));
    REQUIRE(overview.headers.size() == 1);
    CHECK(overview.headers[0].first == "Content-Security-Policy");
    CHECK(has(overview.headers[0].second,
              "; connect-src 'self' http://192.0.2.7:8351 http://192.0.2.8:8351"));
    CHECK(has(overview.headers[0].second, "default-src 'self'; script-src 'self';"));
    CHECK_FALSE(has(assets.answer("/boxes", false).body, "sesame"));
    CHECK(has(overview.body, R"(<meta name="a351-token-configured" content="">)"));
    CHECK(has(Assets({}, "sesame", boxes, true).answer("/boxes", false).body,
              R"(<meta name="a351-token-configured" content="yes">)"));
    CHECK(has(assets.answer("/", true).body,
              R"(<meta name="a351-boxes" content="http://192.0.2.7:8351 http://192.0.2.8:8351">)"));
    CHECK(assets.answer("/", true).headers.empty());
    for (const char* inline_code : {"<script>", " style=", " onclick="})
        CHECK_FALSE(has(overview.body, inline_code));
}

TEST_CASE("an assets directory replaces files of known names and exposes no others") {
    const test::TemporaryDirectory directory;
    std::ofstream(directory.path() / "page.js") << "changed";
    std::ofstream(directory.path() / "secret.js") << "secret";
    const Assets assets(directory.path(), "");
    CHECK(body_of(assets, "/page.js") == "changed");
    CHECK(body_of(assets, "/page.css") == body_of(Assets({}, ""), "/page.css"));
    for (const char* path : {"/secret.js", "/../page.js", "/./page.js", "//page.js", "page.js", "",
                             "/page.js/", "/page.js%00", "/PAGE.JS", "/etc/passwd"}) {
        CAPTURE(path);
        CHECK_FALSE(assets.contains(path));
    }
}
