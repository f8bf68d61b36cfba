#include "daemon/ctl/requests.hpp"

#include <fmt/core.h>

#include "daemon/ctl/screen.hpp"

namespace a351::daemon::ctl {

using nlohmann::json;

Answer answer_of(const Reply& reply) {
    Answer answer{json::parse(reply.body, nullptr, false), ""};
    if (!answer.body.is_object())
        throw NoDaemon("the program at this address is not a351d; check --url");
    if (reply.status == 200) return answer;
    const auto error = answer.body.find("error");
    answer.error = error != answer.body.end() && error->is_string()
                       ? error->get<std::string>()
                       : fmt::format("the daemon answered with status {}", reply.status);
    return answer;
}

Answer send_change(const Client& client, const std::string& token, const std::string& path,
                   const json& body) {
    std::string used = token;
    if (used.empty()) {
        Answer given = answer_of(client.get("/api/token"));
        if (!given.error.empty()) return given;
        used = given.body.value("token", "");
    }
    // Arguments may be invalid UTF-8; invalid parts become U+FFFD, which the daemon does not know.
    const std::string text = body.dump(-1, ' ', false, json::error_handler_t::replace);
    return answer_of(client.post(path, text, used));
}

std::string message_of(const Answer& answer) {
    return printable(answer.body.value("message", "done"));
}

}  // namespace a351::daemon::ctl
