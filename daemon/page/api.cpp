#include "daemon/page/api.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "daemon/page/history_json.hpp"
#include "daemon/page/status_json.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;

constexpr std::size_t kEventsPerAnswer = 1000;

constexpr std::string_view kReadable[] = {"/api/status",     "/api/events", "/api/sites",
                                          "/metrics",        "/api/token",  "/api/history",
                                          "/api/occupations"};
constexpr std::string_view kChangeable[] = {"/api/occupation/start",
                                            "/api/occupation/stop",
                                            "/api/occupation/setup",
                                            "/api/occupation/discard",
                                            "/api/occupation/restore",
                                            "/api/occupation/resume",
                                            "/api/occupation/rename",
                                            "/api/occupation/retime",
                                            "/api/occupation/not_moved",
                                            "/api/note",
                                            "/api/target"};

/// The body of a POST: a JSON object whose values are texts.  A key that is absent, null or ""
/// counts as not given.
struct Order {
    std::string key;        ///< Key of a stay.
    std::string site;       ///< To rename: the correct one; else that of the stay.
    survey::Remark remark;  ///< Keys operator, note and reason.
    std::optional<UtcTime> at, from, to;
};

/// Reads the body of a POST.
/// @param allowed  keys that may be given; others are refused.
/// @throws InputError  not a JSON object, a key that is not allowed, a value that is not a text, or
///                     a time that is not RFC 3339; names the key.
Order parse_order(std::string_view body, const std::vector<std::string>& allowed) {
    const auto parsed = json::parse(body, nullptr, false);
    if (!parsed.is_object()) throw InputError("body: not a JSON object");
    Order order;
    for (const auto& [key, value] : parsed.items()) {
        require_allowed("body", key, allowed);
        if (value.is_null()) continue;
        if (!value.is_string()) throw InputError("body: key " + key + ": not a text");
        const auto text = value.get<std::string>();
        if (key == "key") order.key = text;
        if (key == "site") order.site = text;
        if (key == "operator") order.remark.operator_name = text;
        if (key == "note") order.remark.note = text;
        if (key == "reason") order.remark.reason = text;
        for (const auto& [name, instant] :
             {std::pair{"at", &order.at}, {"from", &order.from}, {"to", &order.to}})
            if (key == name && !text.empty()) *instant = parse_instant("body", key, text);
    }
    return order;
}

/// Reads the body {"target_mgal": number}.
/// @throws InputError  anything else.
MilliGal parse_target(std::string_view body) {
    const auto parsed = json::parse(body, nullptr, false);
    if (!parsed.is_object() || parsed.size() != 1 || !parsed.contains("target_mgal"))
        throw InputError("body: allowed: one key, target_mgal");
    const auto& target = parsed.at("target_mgal");
    if (!target.is_number()) throw InputError("body: key target_mgal: not a number");
    return MilliGal(target.get<double>());
}

/// Makes an answer of this body.  Texts from files and devices may be invalid UTF-8; invalid parts
/// become U+FFFD.
Response ok(const json& body) {
    return {.body = body.dump(-1, ' ', false, json::error_handler_t::replace) + "\n"};
}

Response answer_of(const survey::Outcome& outcome,
                   const std::optional<events::RunningOccupation>& running) {
    if (outcome.kind == survey::Outcome::Kind::refused) return refusal(409, outcome.message);
    if (outcome.kind == survey::Outcome::Kind::failed) return refusal(500, outcome.message);
    return ok({{"message", outcome.message},
               {"occupation", running ? to_json(*running, running->start) : json()}});
}

}  // namespace

Api::Api(ApiSources sources, std::string token)
    : sources_(std::move(sources)), token_(std::move(token)), assets_(sources_.assets, token_) {}

Response Api::answer(const Request& request) noexcept {
    try {
        return route(request);
    } catch (const InputError& error) {
        return refusal(400, error.what());
    } catch (const std::exception& error) {
        ++use_.failures;
        return refusal(500, error.what());
    } catch (...) {
        ++use_.failures;
        return refusal(500, "internal error of the daemon");
    }
}

std::optional<json> Api::status() noexcept {
    try {
        return status_now();
    } catch (...) {
        ++use_.failures;
        return std::nullopt;
    }
}

std::optional<std::string> Api::urgent_status() noexcept {
    try {
        const status::Status status = sources_.status();
        const bool is_fresh =
            status.last_sample && status.now - *status.last_sample <= sources_.stale_after;
        auto text = fmt::format("{}{}{}", to_text(status.level), status.link_state,
                                is_fresh ? verdict::to_text(status.verdict.state) : "stale");
        if (const auto& running = sources_.occupations.running()) {
            text += running->site + to_rfc3339(running->start) +
                    to_rfc3339(running->set_ups.back()) + running->operator_name + running->note;
        }
        return text;
    } catch (...) {
        ++use_.failures;
        return std::nullopt;
    }
}

json Api::status_now() {
    const status::Status status = sources_.status();
    const auto field = survey::field_status(sources_.occupations, sources_.live, status.now);
    return to_json(status, sources_.occupations, field, sources_.live, sources_.stale_after);
}

Response Api::route(const Request& request) {
    const std::string_view target = request.target;
    const auto mark = target.find('?');
    const auto path = target.substr(0, mark);
    const auto query = mark == std::string_view::npos ? "" : target.substr(mark + 1);

    const bool is_readable = std::ranges::count(kReadable, path) > 0 || assets_.contains(path);
    if (!is_readable && std::ranges::count(kChangeable, path) == 0)
        return refusal(404, "there is no such path");
    if (is_readable && (request.method == "GET" || request.method == "HEAD"))
        return read(path, query);
    if (!is_readable && request.method == "POST") {
        if (!query.empty()) throw InputError("query: none is allowed here");
        return change(path, request.body);
    }
    auto response = refusal(405, request.method + " is not allowed here");
    response.headers.emplace_back("Allow", is_readable ? "GET, HEAD" : "POST");
    return response;
}

Response Api::read(std::string_view path, std::string_view query) {
    if (path == "/api/events") return events_since(query);
    if (path == "/api/history")
        return {.body = history_json(sources_.live, query, sources_.status().now)};
    if (!query.empty()) throw InputError("query: none is allowed here");
    if (path == "/api/status") return ok(status_now());
    if (path == "/metrics")
        return {.content_type = kMetricsType, .body = metrics_of(status_now(), use_)};
    if (path == "/api/sites") return sites_around();
    if (path == "/api/occupations") return occupations_so_far();
    if (path == "/api/token") {
        if (token_.empty())
            return refusal(403, "the token is not given out here; use that of [page] token");
        return ok({{"token", token_}});
    }
    return assets_.answer(path);
}

/// Lists the sites by their distance from the last occupation's site, or else from the base.
Response Api::sites_around() const {
    Degrees latitude = sources_.latitude, longitude = sources_.longitude;
    const auto list = sources_.occupations.list();
    const auto& running = sources_.occupations.running();
    const std::string last = running ? running->site : list.empty() ? "" : list.back().site;
    if (const auto* site = text::find_site(sources_.occupations.sites(), last);
        site && site->is_placed) {
        latitude = site->latitude;
        longitude = site->longitude;
    }
    json sites = json::array();
    for (const auto& one : survey::nearest_first(sources_.occupations.sites(), latitude, longitude))
        sites.push_back(to_json(one));
    return ok({{"sites", sites}});
}

Response Api::occupations_so_far() const {
    json list = json::array();
    for (const auto& one : sources_.occupations.list()) {
        list.push_back(to_json(one));
        list.back()["reading"] =
            to_json(survey::reading_of(one.set_ups, sources_.live, sources_.occupations.target()));
    }
    json discarded = json::array();
    for (const auto& one : sources_.occupations.discarded()) discarded.push_back(to_json(one));
    return ok({{"occupations", list}, {"discarded", discarded}});
}

Response Api::events_since(std::string_view query) {
    const auto keys = parse_query(query, {"since"});
    std::optional<UtcTime> since;
    if (const auto given = keys.find("since"); given != keys.end()) {
        since = parse_rfc3339(given->second);
        if (!since) throw InputError("query: since: not an instant; allowed: RFC 3339 in UTC");
    }
    auto events = sources_.events();
    if (since) std::erase_if(events, [&](const auto& event) { return event.utc < *since; });
    // Without `since` the newest events are returned.
    const auto count = std::min(events.size(), kEventsPerAnswer);
    const auto first = since ? 0 : events.size() - count;
    json list = json::array();
    for (std::size_t i = first; i < first + count; ++i)
        list.push_back(json::parse(events::to_json(events[i])));
    return ok({{"events", list}, {"complete", count == events.size()}});
}

Response Api::change(std::string_view path, const std::string& body) {
    auto& occupations = sources_.occupations;
    survey::Outcome outcome;
    if (path == "/api/occupation/start") {
        const auto order = parse_order(body, {"site", "operator", "note", "at"});
        if (order.site.empty()) throw InputError("body: key site is missing");
        outcome = occupations.start(order.site, order.remark, order.at);
    } else if (path == "/api/occupation/stop") {
        const auto order = parse_order(body, {"site", "operator", "note", "at"});
        const auto& running = occupations.running();
        if (running && !order.site.empty() && order.site != running->site)
            return refusal(409, running->site + " is running, not " + order.site);
        outcome = occupations.stop(order.remark, order.at);
    } else if (path == "/api/occupation/setup") {
        outcome = occupations.setup(parse_order(body, {"at"}).at);
    } else if (path == "/api/target") {
        outcome = occupations.set_target(parse_target(body));
    } else if (path == "/api/note") {
        const auto order = parse_order(body, {"key", "site", "note"});
        outcome = occupations.note({order.key, order.site}, order.remark.note);
    } else {
        outcome = change_stay(path.substr(path.rfind('/') + 1), body);
    }
    return answer_of(outcome, occupations.running());
}

/// Carries out discard, restore, resume, rename, retime or not_moved, which name their stay.
survey::Outcome Api::change_stay(std::string_view change, const std::string& body) {
    auto& occupations = sources_.occupations;
    std::vector<std::string> allowed{"key", "site", "reason", "operator", "note"};
    if (change == "retime") allowed.insert(allowed.end(), {"from", "to"});
    const auto order = parse_order(body, allowed);
    if (order.key.empty())
        throw InputError("body: key key is missing: the stay, as GET /api/occupations has it");
    if (change == "rename") {
        if (order.site.empty()) throw InputError("body: key site is missing");
        return occupations.rename({order.key, ""}, order.site, order.remark);
    }
    const survey::Named stay{order.key, order.site};
    if (change == "discard") return occupations.discard(stay, order.remark);
    if (change == "restore") return occupations.restore(stay, order.remark);
    if (change == "resume") return occupations.resume(stay, order.remark);
    if (change == "not_moved") return occupations.not_moved(stay, order.remark);
    return occupations.retime(stay, order.from, order.to, order.remark);
}

}  // namespace a351::daemon::page
