#include "daemon/page/server.hpp"

#include <chrono>
#include <list>
#include <random>
#include <thread>
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/served.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

TEST_CASE(
    "the server enforces the rules of the guard, and a change that was answered 200 is in the "
    "log") {
    Served served;
    CHECK(status_of(served.answer("GET /api/status HTTP/1.1\r\nHost: evil.example\r\n\r\n")) ==
          421);
    CHECK(status_of(served.answer("GET /api/status HTTP/1.1\r\n\r\n")) == 421);
    const std::string body = R"({"note":"a lorry passed"})";
    CHECK(status_of(served.answer(served.post(body, kJson))) == 403);
    CHECK(status_of(served.answer(
              served.post(body, kJson + kWithToken + "Origin: http://evil.example\r\n"))) == 403);
    CHECK(status_of(served.answer(
              served.post(body, "Content-Type: text/plain\r\n" + kWithToken))) == 403);
    const auto preflight = served.answer("OPTIONS /api/note HTTP/1.1\r\n" + served.host() +
                                         "Origin: http://evil.example\r\n"
                                         "Access-Control-Request-Method: POST\r\n\r\n");
    CHECK(status_of(preflight) == 403);
    CHECK(preflight.find("Access-Control") == std::string::npos);
    CHECK(status_of(served.answer(served.post(body, kJson + kWithToken + served.own_origin()))) ==
          200);
    served.server.stop();
    REQUIRE(served.recorder.log.size() == 1);
    CHECK(served.recorder.log.front().details.at("note") == "a lorry passed");
}

TEST_CASE("a header beyond 8 KiB and a body beyond 16 KiB are refused") {
    const Served served;
    const auto padded = [&](std::size_t size) {
        return served.get("/api/status", "X-Padding: " + std::string(size, 'x') + "\r\n");
    };
    CHECK(status_of(served.answer(padded(7 * 1024))) == 200);
    CHECK(status_of(served.answer(padded(8 * 1024))) == 431);
    CHECK(status_of(served.answer(padded(1024 * 1024))) == 431);
    const auto noted = [&](std::size_t size) {
        return served.post(R"({"note":")" + std::string(size, 'x') + "\"}", kJson);
    };
    // This one is read completely and then refused, because it has no token.
    CHECK(status_of(served.answer(noted(16 * 1024 - 11))) == 403);
    CHECK(status_of(served.answer(noted(16 * 1024 - 10))) == 413);
    CHECK(status_of(served.answer(noted(1024 * 1024))) == 413);
    const std::string chunked = "POST /api/note HTTP/1.1\r\n" + served.host() + kJson +
                                "Transfer-Encoding: chunked\r\n\r\n5000\r\n" +
                                std::string(0x5000, 'x') + "\r\n0\r\n\r\n";
    CHECK(status_of(served.answer(chunked)) == 413);
    CHECK(served.is_well());
}

TEST_CASE("slow connections do not shut out others, also if they come again") {
    const Served served;
    std::list<RawClient> slow;
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 200; ++i) {
            slow.emplace_back(served.server.port());
            slow.back().send("GET /api/status HTTP/1.1\r\nHost: ");
        }
        CHECK(served.is_well());
        // Half of them come again.
        for (int i = 0; i < 100; ++i) slow.pop_front();
    }
}

TEST_CASE("a first request that is not begun within 2 s is cut off") {
    const Served served;
    const RawClient quiet(served.server.port());
    const auto begun = std::chrono::steady_clock::now();
    CHECK(quiet.rest().empty());
    const auto after = std::chrono::steady_clock::now() - begun;
    CHECK(after > std::chrono::milliseconds(1500));
    CHECK(after < std::chrono::milliseconds(5000));
}

TEST_CASE("the connection that waits longest makes room, and closed connections make room again") {
    const Served served;
    {
        std::list<RawClient> seated;
        for (int i = 0; i < 32; ++i) {
            seated.emplace_back(served.server.port());
            seated.back().send(served.get("/api/status"));
            REQUIRE(status_of(seated.back().response()) == 200);
        }
        const RawClient late(served.server.port());
        late.send(served.get("/api/status"));
        CHECK(status_of(late.response()) == 200);
        CHECK(seated.front().rest().empty());
        seated.back().send(served.get("/api/status"));
        CHECK(status_of(seated.back().response()) == 200);
    }
    CHECK(served.is_well());
}

TEST_CASE("clients that never read their answers do not shut out others") {
    const Served served;
    std::list<RawClient> deaf;
    for (int i = 0; i < 40; ++i) {
        deaf.emplace_back(served.server.port());
        // More than the buffers of both ends take.
        for (int n = 0; n < 100; ++n) deaf.back().send(served.get("/dygraph.min.js"));
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));  // Until the buffers are full.
    CHECK(served.is_well());
}

TEST_CASE("a request that is not complete in time is cut off") {
    ServerOptions options;
    options.request_limit = std::chrono::milliseconds(200);
    const Served served(options);
    const RawClient silent(served.server.port());
    const RawClient half(served.server.port());
    half.send("GET /api/status HTTP/1.1\r\nHost: ");
    // A byte now and then does not extend the time limit.
    const RawClient trickle(served.server.port());
    for (int i = 0; i < 20; ++i) {
        trickle.send("x");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    CHECK(silent.rest().empty());
    CHECK(half.rest().empty());
    CHECK(trickle.rest().empty());
    CHECK(served.is_well());
}

TEST_CASE("requests sent at once are answered in order") {
    const Served served;
    const RawClient client(served.server.port());
    client.send(served.get("/api/status") + served.get("/nowhere") + served.get("/api/sites") +
                served.get("/api/token", "Connection: close\r\n") + served.get("/api/status"));
    const auto all = client.rest();
    std::vector<std::string> codes;
    for (auto at = all.find("HTTP/1.1 "); at != std::string::npos;
         at = all.find("HTTP/1.1 ", at + 1))
        codes.push_back(all.substr(at + 9, 3));
    CHECK(codes == std::vector<std::string>{"200", "404", "200", "200"});
    CHECK(all.find(kToken) != std::string::npos);
}

TEST_CASE("HEAD is answered without a body") {
    const Served served;
    const RawClient client(served.server.port());
    client.send("HEAD /api/sites HTTP/1.1\r\n" + served.host() + "Connection: close\r\n\r\n");
    const auto answer = client.rest();
    CHECK(status_of(answer) == 200);
    CHECK(answer.ends_with("\r\n\r\n"));
    CHECK(answer.find("Content-Type: application/json") != std::string::npos);
    CHECK(answer.find("Content-Length: 0") == std::string::npos);
}

TEST_CASE(
    "a server has addresses of loopback only, refuses a port in use, and can be stopped twice") {
    Served served;
    const auto port = std::to_string(served.server.port());
    const auto& addresses = served.server.addresses();
    REQUIRE_FALSE(addresses.empty());
    CHECK(addresses.front() == "127.0.0.1:" + port);
    if (addresses.size() > 1) CHECK(addresses.at(1) == "[::1]:" + port);
    CHECK_FALSE(served.server.is_exposed());
    auto options = Served::own({});
    options.listen.port = served.server.port();
    CHECK_THROWS_AS(Server(options, served.sources()), std::system_error);

    const RawClient open(served.server.port());
    open.send(served.get("/api/status"));
    CHECK(status_of(open.response()) == 200);
    served.server.stop();
    served.server.stop();
    const Server never_started(Served::own({}), served.sources());
    CHECK(never_started.port() != 0);
}

TEST_CASE("bytes that are not a request do no harm") {
    const Served served;
    for (const std::string& bytes :
         {std::string("\0\0\0\0", 4), std::string("\x16\x03\x01\x02\x00\x01\xfc\x03\x03", 9),
          std::string("GET\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
          std::string("\r\n\r\n\r\n"), std::string("POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"),
          std::string("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"),
          std::string("GET / HTTP/1.1\r\nHost : x\r\n\r\n"), std::string()}) {
        const RawClient client(served.server.port());
        client.send(bytes);
        client.finish_sending();
        const int status = status_of(client.rest());
        CAPTURE(bytes, status);
        CHECK((status == 0 || status == 400 || status == 413));
    }
    std::mt19937 random(351);
    for (int i = 0; i < 200; ++i) {
        std::string bytes = served.get("/api/status");
        for (int k = 0; k < 5; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
        const RawClient client(served.server.port());
        client.send(bytes);
        client.finish_sending();
        CHECK(client.rest().find("(no end)") == std::string::npos);
    }
    CHECK(served.is_well());
}

TEST_CASE("a client that leaves before the answer does no harm") {
    const Served served;
    for (int i = 0; i < 50; ++i) {
        const RawClient client(served.server.port());
        client.send(served.get("/api/status"));
    }
    CHECK(served.is_well());
}
