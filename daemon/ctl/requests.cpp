#include "daemon/ctl/requests.hpp"

#include "daemon/ctl/screen.hpp"
#include "protocol/text/json_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {

using nlohmann::json;

std::string sentence_of(const json& object, const char* key, const char* parts) {
    if (!object.is_object()) return {};
    const auto english = object.find(key);
    if (english == object.end() || !english->is_string()) return {};
    return text::in_words(
        text::parse_message(object.value(parts, json()), english->get_ref<const std::string&>()));
}

void throw_no_daemon() {
    throw NoDaemon(text::tr("the program at this address is not a351d; check --url"));
}

Answer answer_of(const Reply& reply) {
    Answer answer{json::parse(reply.body, nullptr, false), ""};
    if (!answer.body.is_object() || answer.body.empty()) throw_no_daemon();
    if (reply.status == 200) return answer;
    answer.error = sentence_of(answer.body, "error", "error_parts");
    if (answer.error.empty())
        answer.error = text::tr("the daemon answered with status {}", reply.status);
    return answer;
}

Answer send_change(const Client& client, const std::string& token, const std::string& path,
                   const json& body) {
    std::string used = token;
    if (used.empty()) {
        Answer given = answer_of(client.get("/api/token"));
        if (!given.error.empty()) return given;
        if (!given.body.contains("token")) throw_no_daemon();
        used = given.body.value("token", "");
    }
    return answer_of(client.post(path, text::json_text(body), used));
}

std::string message_of(const Answer& answer) {
    const std::string said = sentence_of(answer.body, "message", "message_parts");
    if (said.empty()) throw_no_daemon();
    return printable(said);
}

}  // namespace a351::daemon::ctl
