#include "daemon/page/guard.hpp"

#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

namespace {

int refused_with(const Guard& guard, const Request& request) {
    const auto response = guard.refuse(request);
    return response ? response->status : 200;
}

}  // namespace

TEST_CASE("a request for an unknown Host is answered 421") {
    const Guard guard(8351, {"Gravbox", "field.example:80"}, kToken);
    for (const char* host : {"127.0.0.1:8351", "localhost:8351", "LocalHost:8351", "[::1]:8351",
                             "gravbox:8351", "GRAVBOX:8351", "field.example:80", "field.example"})
        CHECK(refused_with(guard, with(get("/"), "Host", host)) == 200);
    for (const char* host :
         {"evil.example:8351", "127.0.0.1", "127.0.0.1:80", "localhost", "localhost:83511", "",
          "gravbox", "127.0.0.1:8351.evil.example", "localhost:8351 "}) {
        CHECK(refused_with(guard, with(get("/"), "Host", host)) == 421);
        CHECK(refused_with(guard, with(post("/api/note"), "Host", host)) == 421);
    }
    CHECK(refused_with(guard, without(get("/"), "Host")) == 421);
    auto phone = with(get("/"), "Host", "192.0.2.7:8351");
    CHECK(refused_with(guard, phone) == 421);
    phone.address = "192.0.2.7:8351";
    CHECK(refused_with(guard, phone) == 200);
    auto two = get("/");
    two.headers.emplace_back("host", "127.0.0.1:8351");
    CHECK(refused_with(guard, two) == 421);
    // Under DNS rebinding Host and Origin agree.
    const auto rebound = with(post("/api/note"), "Host", "evil.example:8351");
    CHECK(refused_with(guard, with(rebound, "Origin", "http://evil.example:8351")) == 421);
}

TEST_CASE("port 80 and a proxy with TLS are reached by names without a port") {
    const Guard usual(80, {"gravbox"}, kToken);
    for (const char* host : {"gravbox", "gravbox:80", "127.0.0.1", "localhost:80", "[::1]"})
        CHECK(refused_with(usual, with(get("/"), "Host", host)) == 200);
    auto phone = with(get("/"), "Host", "192.0.2.7");
    phone.address = "192.0.2.7:80";
    CHECK(refused_with(usual, phone) == 200);

    const Guard proxied(8351, {"https://gravbox.example", "https://other.example:8443"}, kToken);
    const auto change = [&](const char* host, const char* origin) {
        return refused_with(proxied, with(with(post("/api/note"), "Host", host), "Origin", origin));
    };
    CHECK(change("gravbox.example", "https://gravbox.example") == 200);
    CHECK(change("GravBox.example", "HTTPS://GravBox.example") == 200);
    CHECK(change("other.example:8443", "https://other.example:8443") == 200);
    CHECK(change("127.0.0.1:8351", "https://gravbox.example") == 200);  // a proxy that sets Host
    CHECK(change("gravbox.example", "http://gravbox.example") == 403);
    CHECK(change("gravbox.example", "https://evil.example") == 403);
    CHECK(change("gravbox.example:8351", "https://gravbox.example") == 421);
    CHECK(change("other.example", "https://other.example:8443") == 421);
}

TEST_CASE("a request that changes something is refused if its Origin is another site") {
    const Guard guard(8351, {"gravbox"}, kToken);
    for (const char* origin : {"http://127.0.0.1:8351", "http://localhost:8351",
                               "http://[::1]:8351", "http://gravbox:8351"})
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 200);
    for (const char* origin : {"http://evil.example", "null", "", "https://127.0.0.1:8351",
                               "http://127.0.0.1:80", "127.0.0.1:8351"})
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 403);
}

TEST_CASE("a change needs the token, even without an Origin") {
    const Guard guard(8351, {}, kToken);
    CHECK(refused_with(guard, post("/api/note")) == 200);
    CHECK(refused_with(guard, without(post("/api/note"), "X-A351-Token")) == 403);
    for (const std::string& token : {std::string(), kToken + "0", kToken.substr(1), "x" + kToken,
                                     std::string(kToken.size(), 'x')})
        CHECK(refused_with(guard, with(post("/api/note"), "X-A351-Token", token)) == 403);
    const auto page = with(post("/api/note"), "Origin", "http://127.0.0.1:8351");
    CHECK(refused_with(guard, without(page, "X-A351-Token")) == 403);
    auto delete_request = without(post("/api/note"), "X-A351-Token");
    delete_request.method = "DELETE";
    CHECK(refused_with(guard, delete_request) == 403);
    const Guard without_token(8351, {}, "");
    CHECK(refused_with(without_token, with(post("/api/note"), "X-A351-Token", "")) == 403);
}

TEST_CASE("a change must be application/json, because a form can be sent across sites") {
    const Guard guard(8351, {}, kToken);
    for (const char* type :
         {"application/json", "application/json; charset=utf-8", "Application/JSON ;charset=utf-8"})
        CHECK(refused_with(guard, with(post("/api/note"), "Content-Type", type)) == 200);
    for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "", ";",
                             "application/json5", "text/plain; application/json"})
        CHECK(refused_with(guard, with(post("/api/note"), "Content-Type", type)) == 403);
    CHECK(refused_with(guard, without(post("/api/note"), "Content-Type")) == 403);
}

TEST_CASE("pages of the boxes that are configured may read and change, with the token") {
    const Guard guard(8351, {}, kToken, {"http://192.0.2.7:8351", "http://Box2:80"});
    const auto shown_to = [&](const char* origin) {
        page::Response response;
        guard.show_box(with(get("/api/status"), "Origin", origin), response);
        for (const auto& [name, value] : response.headers)
            if (name == "Access-Control-Allow-Origin") return value;
        return std::string();
    };
    for (const std::string origin : {"http://192.0.2.7:8351", "http://box2"}) {
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 200);
        CHECK(refused_with(guard, without(with(post("/api/note"), "Origin", origin),
                                          "X-A351-Token")) == 403);
        CHECK(shown_to(origin.c_str()) == origin);
        auto question = with(get("/api/note"), "Origin", origin);
        question.method = "OPTIONS";
        const auto answer = guard.refuse(question);
        REQUIRE(answer);
        CHECK(answer->status == 200);
        CHECK(answer->headers.size() == 2);
        CHECK(refused_with(guard, with(question, "Host", "evil.example:8351")) == 421);
    }
    for (const char* origin : {"http://192.0.2.7:8352", "https://192.0.2.7:8351", "null", "",
                               "http://192.0.2.7:8351.evil.example", "http://evil.example"}) {
        CAPTURE(origin);
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 403);
        CHECK(shown_to(origin).empty());
        auto question = with(get("/api/note"), "Origin", origin);
        question.method = "OPTIONS";
        CHECK(refused_with(guard, question) == 403);
    }
    // A page of another computer, in a browser on this one, must not get the token of this one.
    for (const char* target : {"/api/token", "/api/token?x", "/", "/boxes", "/live"}) {
        CAPTURE(target);
        CHECK(refused_with(guard, with(get(target), "Origin", "http://192.0.2.7:8351")) == 403);
        CHECK(refused_with(guard, get(target)) == 200);
    }
    CHECK(refused_with(guard, with(get("/api/status"), "Origin", "http://192.0.2.7:8351")) == 200);
    const Guard neighbour(8351, {"192.0.2.7"}, kToken,
                          {"http://127.0.0.1:8352", "http://192.0.2.7:8351", "http://localhost",
                           "http://127.0.0.1.evil.example", "http://localhost.evil.example:8352"});
    for (const char* origin : {"http://127.0.0.1:8352", "http://localhost",
                               "http://192.0.2.7:8351"})  // The last is its own.
        CHECK(refused_with(neighbour, with(get("/api/token"), "Origin", origin)) == 200);
    for (const char* origin :
         {"http://127.0.0.1.evil.example", "http://localhost.evil.example:8352"})
        CHECK(refused_with(neighbour, with(get("/api/token"), "Origin", origin)) == 403);
    // The name of another box is not a name of this one.
    CHECK(refused_with(guard, with(get("/"), "Host", "192.0.2.7:8351")) == 421);
}

TEST_CASE("random tokens have 256 bits and differ") {
    const auto token = random_token();
    CHECK(token.size() == 64);
    CHECK(token.find_first_not_of("0123456789abcdef") == std::string::npos);
    CHECK(random_token() != token);
}
