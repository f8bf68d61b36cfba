#pragma once

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>

#include "daemon/page/server.hpp"
#include "tests/unit/daemon/live_records.hpp"
#include "tests/unit/daemon/page_token.hpp"
#include "tests/unit/daemon/raw_client.hpp"

namespace a351::daemon {

/// A real server on a free port of loopback.
struct Served {
    explicit Served(page::ServerOptions options = {}, int rate_hz = 50)
        : live(*wire::find_profile("A351"), rate_hz, {}), server(own(options), sources()) {
        server.start();
    }

    static page::ServerOptions own(page::ServerOptions options) {
        options.listen.port = 0;
        options.token = kToken;
        return options;
    }
    page::ApiSources sources() {
        return {
            .status =
                [this] {
                    const std::lock_guard lock(mutex);
                    if (is_failing) throw std::runtime_error("no status");
                    return status;
                },
            .occupations = occupations,
            .live = live,
            .events = [this] { return recorder.log; },
            .gravity_so_far =
                [] { return R"({"as_of_utc":null,"reason":"no_sites","stays":[],"findings":[]})"; },
            .bundle = [this] { return bundle(); }};
    }

    [[nodiscard]] std::string host() const {
        return "Host: 127.0.0.1:" + std::to_string(server.port()) + "\r\n";
    }
    [[nodiscard]] std::string own_origin() const {
        return "Origin: http://127.0.0.1:" + std::to_string(server.port()) + "\r\n";
    }
    [[nodiscard]] std::string get(const std::string& path, const std::string& more = "") const {
        return "GET " + path + " HTTP/1.1\r\n" + host() + more + "\r\n";
    }
    [[nodiscard]] std::string post(const std::string& body, const std::string& headers) const {
        return "POST /api/note HTTP/1.1\r\n" + host() +
               "Content-Length: " + std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body;
    }
    [[nodiscard]] std::string answer(const std::string& request) const {
        const RawClient client(server.port());
        client.send(request);
        return client.response();
    }
    [[nodiscard]] bool is_well() const { return status_of(answer(get("/api/status"))) == 200; }

    void set_level(status::Status::Level level) {
        const std::lock_guard lock(mutex);
        status.level = level;
    }

    std::function<page::Download()> bundle;  ///< Set it before the request.
    std::atomic<bool> is_failing{false};
    std::mutex mutex;
    status::Status status;
    FakeRecorder recorder;
    survey::Occupations occupations{recorder, two_sites(), {}};
    live::Record live;
    page::Server server;
};

inline const std::string kJson = "Content-Type: application/json\r\n";
inline const std::string kWithToken = "X-A351-Token: " + kToken + "\r\n";

}  // namespace a351::daemon
