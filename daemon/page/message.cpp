#include "daemon/page/message.hpp"

#include <strings.h>

#include <nlohmann/json.hpp>

namespace a351::daemon {

std::vector<std::string> Request::values(std::string_view name) const {
    std::vector<std::string> found;
    for (const auto& [key, value] : headers) {
        if (key.size() == name.size() && strncasecmp(key.data(), name.data(), name.size()) == 0) {
            found.push_back(value);
        }
    }
    return found;
}

Response refusal(int status, std::string_view trouble) {
    const nlohmann::json body = {{"error", std::string(trouble)}};
    return {.status = status,
            .body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"};
}

std::string joined(const std::vector<std::string>& keys) {
    std::string text;
    for (const auto& key : keys) text += (text.empty() ? "" : ", ") + key;
    return text.empty() ? "none" : text;
}

}  // namespace a351::daemon
