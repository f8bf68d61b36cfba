#include <list>
#include <thread>
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/raw_viewer.hpp"

using namespace a351;
using namespace a351::daemon;

namespace {

int asked(const Served& served, const std::string& host, const std::string& headers) {
    const auto answer = served.answer(RawViewer::request(host, headers));
    CHECK(answer.find("Access-Control") == std::string::npos);
    if (status_of(answer) != 101) CHECK(answer.find("Sec-WebSocket-Accept") == std::string::npos);
    return status_of(answer);
}

const std::string kForeign = "Origin: http://evil.example\r\n";

}  // namespace

TEST_CASE("a stream request for a foreign Host is answered 421 before any upgrade") {
    const Served served;
    const auto port = std::to_string(served.server.port());
    const auto own = served.own_origin();
    CHECK(asked(served, served.host(), own) == 101);
    CHECK(asked(served, "Host: LOCALHOST:" + port + "\r\n", own) == 101);
    for (const std::string& host :
         {std::string(), std::string("Host: evil.example\r\n"), served.host() + served.host(),
          served.host() + "Host: evil.example\r\n"}) {
        CAPTURE(host);
        CHECK(asked(served, host, own) == 421);
        CHECK(asked(served, host, kWithToken) == 421);
    }
    // DNS rebinding: Host and Origin both carry the attacker's name.
    CHECK(asked(served, "Host: evil.example:" + port + "\r\n",
                "Origin: http://evil.example:" + port + "\r\n") == 421);
}

TEST_CASE("a stream with a foreign Origin, or with neither Origin nor token, is forbidden") {
    const Served served;
    const auto port = std::to_string(served.server.port());
    for (const std::string& origin :
         {kForeign, std::string("Origin: null\r\n"), std::string("Origin: \r\n"),
          kForeign + served.own_origin(), served.own_origin() + kForeign}) {
        CAPTURE(origin);
        CHECK(asked(served, served.host(), origin) == 403);
        CHECK(asked(served, served.host(), origin + kWithToken) == 403);
    }
    CHECK(asked(served, served.host(), "") == 403);
    CHECK(asked(served, served.host(), "X-A351-Token: guess\r\n") == 403);
    CHECK(asked(served, served.host(), kWithToken) == 101);
    CHECK(asked(served, served.host(), "Origin: http://[::1]:" + port + "\r\n") == 101);
}

TEST_CASE("no spelling of the Upgrade header bypasses the check of Origin") {
    const Served served;
    for (const char* upgrade : {"WebSocket", "h2c, websocket", "websocket, h2c", "WEBSOCKET/13"}) {
        CAPTURE(upgrade);
        const auto answer = served.answer(
            "GET /live HTTP/1.1\r\n" + served.host() +
            "Connection: keep-alive, Upgrade\r\nUpgrade: " + upgrade +
            "\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
            kForeign + "\r\n");
        CHECK(status_of(answer) == 403);
    }
    // An upgrade to another protocol is treated as a plain request.
    CHECK(status_of(served.answer(served.get("/api/status", "Upgrade: h2c\r\n"))) == 200);
}

TEST_CASE("the stream accepts WebSocket upgrades only, and no other path accepts them") {
    const Served served;
    const auto plain = served.answer(served.get("/live"));
    CHECK(status_of(plain) == 426);
    CHECK(plain.find("Upgrade: websocket") != std::string::npos);
    CHECK(status_of(served.answer(served.get("/live?x=1"))) == 404);
    const auto elsewhere = served.answer(
        served.get("/api/status",
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                       served.own_origin()));
    CHECK(status_of(elsewhere) == 200);
    const auto keyless = served.answer(served.get(
        "/live", "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n" +
                     served.own_origin()));
    CHECK((status_of(keyless) == 400 || status_of(keyless) == 426));
    const auto long_header = served.answer(RawViewer::request(
        served.host(), served.own_origin() + "X-Padding: " + std::string(8 * 1024, 'x') + "\r\n"));
    CHECK(status_of(long_header) == 431);
    CHECK(served.is_well());
}

TEST_CASE("every answer has the security headers, including files and upgrades") {
    const Served served;
    const RawViewer viewer(served);
    std::vector<std::string> answers{viewer.answer()};
    for (const char* path :
         {"/", "/page.js", "/page.css", "/dygraph.min.js", "/metrics", "/api/token",
          "/api/history?channel=x", "/api/sites", "/live", "/nowhere"})
        answers.push_back(served.answer(served.get(path)));
    answers.push_back(served.answer(served.post("{}", kJson)));
    answers.push_back(served.answer("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"));
    answers.push_back(served.answer("GET / HTTP/9.9\r\n\r\n"));
    answers.push_back(served.answer(RawViewer::request(served.host(), kForeign)));
    for (const auto& answer : answers) {
        const auto head = answer.substr(0, answer.find("\r\n\r\n"));
        CAPTURE(head);
        for (const char* header :
             {"Cache-Control: no-store", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
              "Cross-Origin-Resource-Policy: same-origin", "Referrer-Policy: no-referrer",
              "Content-Security-Policy: default-src 'self'; script-src 'self'; style-src 'self'",
              "frame-ancestors 'none'"}) {
            CAPTURE(header);
            CHECK(head.find(header) != std::string::npos);
        }
        CHECK(head.find("Access-Control") == std::string::npos);
    }
}

TEST_CASE("the 21st stream is answered 503, and other requests are still answered") {
    const Served served;
    {
        std::list<RawViewer> viewers;
        for (int i = 0; i < 20; ++i) {
            viewers.emplace_back(served);
            REQUIRE(viewers.back().status() == 101);
        }
        const RawViewer late(served);
        CHECK(late.status() == 503);
        // The refused connection can still send plain requests.
        late.client().send(served.get("/api/status"));
        CHECK(status_of(late.client().response()) == 200);
        CHECK(served.answer(served.get("/metrics")).find("\na351_page_streams 20\n") !=
              std::string::npos);
        viewers.front().send(RawViewer::close, "");
        CHECK(viewers.front().next(RawViewer::close));
    }
    int status = 0;
    for (int i = 0; i < 200 && status != 101; ++i) {
        status = RawViewer(served).status();
        if (status != 101) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    CHECK(status == 101);
}

TEST_CASE("a client message of more than 4 KiB ends its stream, smaller ones are ignored") {
    const Served served;
    const RawViewer polite(served);
    polite.send(RawViewer::text, std::string(4 * 1024, 'x'));
    polite.send(RawViewer::binary, "\xff");
    polite.send(RawViewer::ping, "still there?");
    const auto pong = polite.next(RawViewer::pong);
    REQUIRE(pong);
    CHECK(pong->payload == "still there?");

    const auto code_of = [](const std::optional<RawViewer::Frame>& frame) {
        if (!frame || frame->payload.size() < 2) return 0;
        return static_cast<unsigned char>(frame->payload[0]) * 256 +
               static_cast<unsigned char>(frame->payload[1]);
    };
    const RawViewer large(served);
    large.send(RawViewer::text, std::string(4 * 1024 + 1, 'x'));
    CHECK(code_of(large.next(RawViewer::close)) == 1009);
    CHECK_FALSE(large.next());
    const RawViewer pieces(served);
    pieces.send(RawViewer::text, std::string(4 * 1024, 'x'), false);
    pieces.send(static_cast<RawViewer::Kind>(0), "x");
    CHECK(code_of(pieces.next(RawViewer::close)) == 1009);
    const RawViewer broken(served);
    broken.client().send("\x81\x02no");  // Not masked.
    CHECK(code_of(broken.next(RawViewer::close)) == 1002);

    polite.send(RawViewer::ping, "now?");
    CHECK(polite.next(RawViewer::pong));
}
