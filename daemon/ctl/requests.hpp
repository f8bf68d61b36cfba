#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/ctl/client.hpp"

namespace a351::daemon::ctl {

/// Says that the program that answered is not the daemon.
/// @throws NoDaemon  always.
[[noreturn]] void throw_no_daemon();

/// An answer of the daemon.
struct Answer {
    nlohmann::json body;  ///< An object.
    /// Why the daemon refused, one sentence in the language of this program; empty if it did not.
    std::string error;
};

/// Reads the body of a reply.
/// @throws NoDaemon  the program at this address is not a351d.
[[nodiscard]] Answer answer_of(const Reply& reply);

/// Sends a change.
/// @param token  empty: the daemon is asked for it.
/// @throws NoDaemon
[[nodiscard]] Answer send_change(const Client& client, const std::string& token,
                                 const std::string& path, const nlohmann::json& body);

/// Returns a sentence of the daemon in the language of this program.
/// @param object  has the sentence in English under `key`, and its parts under `parts`.
/// @return        empty if there is none.
[[nodiscard]] std::string sentence_of(const nlohmann::json& object, const char* key,
                                      const char* parts);

/// Returns the sentence with which the daemon confirms a change.
[[nodiscard]] std::string message_of(const Answer& answer);

}  // namespace a351::daemon::ctl
