#include "daemon/page/api.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <span>

#include "daemon/page/history_json.hpp"
#include "daemon/page/order.hpp"
#include "daemon/page/status_fields.hpp"
#include "daemon/page/status_json.hpp"
#include "daemon/page/status_rows.hpp"
#include "daemon/survey/operator_signal.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;

constexpr std::size_t kEventsPerAnswer = 1000;

constexpr std::string_view kReadable[] = {"/api/status", "/api/events",      "/api/sites",
                                          "/metrics",    "/api/token",       "/api/history",
                                          "/api/rows",   "/api/occupations", "/api/survey"};
constexpr std::string_view kChangeable[] = {"/api/occupation/start",
                                            "/api/occupation/stop",
                                            "/api/occupation/setup",
                                            "/api/occupation/discard",
                                            "/api/occupation/restore",
                                            "/api/occupation/resume",
                                            "/api/occupation/rename",
                                            "/api/occupation/retime",
                                            "/api/occupation/not_moved",
                                            "/api/occupation/checked",
                                            "/api/note",
                                            "/api/sites"};

Response ok(const json& body) { return {.body = text::json_text(body) + "\n"}; }

/// Returns the language whose catalogue is at this path, as /ja.json.
std::optional<text::Language> language_at(std::string_view path) {
    for (const text::Language& one : text::other_languages())
        if (path == fmt::format("/{}.json", one.code)) return one;
    return std::nullopt;
}

Response answer_of(const survey::Outcome& outcome,
                   const std::optional<events::RunningOccupation>& running) {
    if (outcome.kind == survey::Outcome::Kind::refused) return refusal(409, outcome.message);
    if (outcome.kind == survey::Outcome::Kind::failed) return refusal(500, outcome.message);
    return ok({{"message", outcome.message},
               {"message_parts", outcome.message.to_json()},
               {"occupation", running ? to_json(*running, running->start) : json()}});
}

/// Returns why the running stay is not the one that a request names; empty if it is, or if the
/// request names none.
text::Message other_stay(const Order& order,
                         const std::optional<events::RunningOccupation>& running) {
    if (!running) return {};  // refused by Occupations
    if ((order.key.empty() || order.key == running->key) &&
        (order.site.empty() || order.site == running->site))
        return {};
    return text::message("{} (stay {}) is running, not {}; nothing was changed", running->site,
                         running->number, order.site.empty() ? order.key : order.site);
}

}  // namespace

Api::Api(ApiSources sources, std::string token, std::string listen)
    : sources_(std::move(sources)),
      token_(std::move(token)),
      listen_(std::move(listen)),
      assets_(sources_.assets, token_, sources_.boxes, sources_.is_token_configured) {}

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

std::optional<json> Api::live_status() noexcept {
    try {
        const json status = status_now();
        return json{{"status", status}, {"rows", to_json(recorder_rows(status))}};
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
        return fmt::format("{}{}{}{}", to_text(status.level), status.link_state,
                           is_fresh ? verdict::to_text(status.verdict.state) : "stale",
                           sources_.occupations.changes());
    } catch (...) {
        ++use_.failures;
        return std::nullopt;
    }
}

json Api::status_now() const {
    status::Status status = sources_.status();
    const auto field = survey::field_status(sources_.occupations, sources_.live, status.now);
    const Judgement judgement = judged(status, sources_.stale_after);
    const survey::SoFar so_far = so_far_now();
    const survey::Signal signal = survey::operator_signal(
        status, judgement.verdict, judgement.reasons, sources_.occupations, field, so_far);
    return to_json({status, sources_.occupations, field, sources_.live, judgement, signal, so_far});
}

survey::SoFar Api::so_far_now() const {
    return sources_.so_far ? sources_.so_far() : survey::SoFar();
}

Response Api::route(const Request& request) {
    const std::string_view target = request.target;
    const auto mark = target.find('?');
    const auto path = target.substr(0, mark);
    const auto query = mark == std::string_view::npos ? "" : target.substr(mark + 1);

    const bool is_readable =
        std::ranges::count(kReadable, path) > 0 || language_at(path) || assets_.contains(path);
    const bool is_changeable = std::ranges::count(kChangeable, path) > 0;
    if (!is_readable && !is_changeable) return refusal(404, "there is no such path");
    if (is_readable && (request.method == "GET" || request.method == "HEAD"))
        return read(path, query, request.is_local);
    if (is_changeable && request.method == "POST") {
        if (!query.empty()) throw InputError("query: none is allowed here");
        return change(path, request.body);
    }
    auto response = refusal(405, request.method + " is not allowed here");
    response.headers.emplace_back("Allow", !is_readable    ? "POST"
                                           : is_changeable ? "GET, HEAD, POST"
                                                           : "GET, HEAD");
    return response;
}

Response Api::read(std::string_view path, std::string_view query, bool is_local) {
    if (path == "/api/events") return events_since(query);
    if (path == "/api/history")
        return {.body = history_json(sources_.live, query, sources_.status().now)};
    if (!query.empty()) throw InputError("query: none is allowed here");
    if (path == "/api/status") return ok(status_now());
    if (path == "/api/rows") return rows();
    if (path == "/metrics")
        return {.content_type = kMetricsType, .body = metrics_of(status_now(), use_)};
    if (path == "/api/sites") return sites_around();
    if (path == "/api/occupations") return occupations_so_far();
    if (path == "/api/survey") return {.body = sources_.gravity_so_far()};
    if (const auto language = language_at(path)) {
        json texts = json::object();
        for (const auto& [english, other] : text::catalogue(*language))
            texts[std::string(english)] = other;
        return ok(texts);
    }
    if (path == "/api/token") {
        if (!is_local)
            return refusal(
                403, text::message("the token is given out only on the computer of the daemon"));
        return ok({{"token", token_}, {"listen", listen_}});
    }
    return assets_.answer(path, is_local);
}

/// Answers with the rows of recorder and sensor; those of the stay follow the first one.
Response Api::rows() const {
    const json status = status_now();
    std::vector<Row> rows = recorder_rows(status);
    const std::vector<Row> of_stay = operator_rows(status);
    rows.insert(rows.begin() + 1, of_stay.begin(), of_stay.end());
    return ok({{"level", status.at("level")}, {"rows", to_json(rows)}});
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
    const text::Message& doubt = sources_.occupations.doubtful_site();
    return ok({{"sites", sites}, {"doubt", doubt.english()}, {"doubt_parts", doubt.to_json()}});
}

Response Api::occupations_so_far() const {
    json list = json::array();
    const survey::SoFar so_far = so_far_now();
    for (const auto& one : sources_.occupations.list()) {
        list.push_back(to_json(one));
        list.back()["gravity"] = gravity_of(so_far, one.key);
        const auto reading = [&](std::span<const events::Occupation::SetUp> set_ups) {
            return to_json(sources_.live.reading(set_ups));
        };
        list.back()["reading"] = reading(one.set_ups);
        for (std::size_t i = 0; i < one.set_ups.size(); ++i)
            list.back()["set_ups"][i]["reading"] = reading({&one.set_ups[i], 1});
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
    if (sources_.changing) sources_.changing();
    survey::Outcome outcome;
    if (path == "/api/occupation/start") {
        const auto order = parse_order(body, {"site", "operator", "note", "at", "set_ups", "face"});
        if (order.site.empty()) throw InputError("body: key site is missing");
        if (const auto missing = missing_samples(); !order.at && !missing.empty())
            return refusal(409, missing);
        outcome = occupations.start(order.site, order.remark, order.at, order.set_ups, order.face);
        if (outcome.kind == survey::Outcome::Kind::refused && occupations.running())
            outcome.message += move_since_start();
    } else if (path == "/api/occupation/stop") {
        const auto order = parse_order(body, {"key", "site", "operator", "note", "at"});
        if (const auto other = other_stay(order, occupations.running()); !other.empty())
            return refusal(409, other);
        outcome = occupations.stop(order.remark, order.at);
    } else if (path == "/api/occupation/setup") {
        const auto order = parse_order(body, {"key", "site", "at", "face"});
        if (const auto other = other_stay(order, occupations.running()); !other.empty())
            return refusal(409, other);
        if (const auto missing = missing_samples(); !order.at && !missing.empty())
            return refusal(409, missing);
        const auto last = sources_.live.last_sample();
        const auto at = order.at ? order.at : last;
        outcome = occupations.setup(
            order.at, {order.face, at ? survey::next_planned_face(occupations, sources_.live, *at)
                                      : std::nullopt});
    } else if (path == "/api/occupation/checked") {
        outcome = check(parse_order(body, {"code", "key"}));
    } else if (path == "/api/sites") {
        outcome = occupations.add_site(parse_new_site(body));
    } else if (path == "/api/note") {
        const auto order = parse_order(body, {"key", "site", "note"});
        outcome = occupations.note({order.key, order.site}, order.remark.note);
    } else {
        outcome = change_stay(path.substr(path.rfind('/') + 1), body);
    }
    if (outcome.kind == survey::Outcome::Kind::done && sources_.changed) sources_.changed();
    return answer_of(outcome, occupations.running());
}

/// Says since when no samples have come, so that no stay or set-up can begin now; empty if they come.
text::Message Api::missing_samples() const {
    constexpr int kPatience = 4;  // A plug that is loose for a moment is no reason to refuse.
    const status::Status status = sources_.status();
    // While samples come they can seem old, because the host's clock was set.
    if (!status.last_sample || status.link_state == "sampling" ||
        status.now - *status.last_sample <= kPatience * sources_.stale_after)
        return {};
    return text::message(
        "no samples have come since {}, so nothing can begin now: check the sensor's plug",
        to_rfc3339(*status.last_sample, 0));
}

/// Says when the box of the running stay was carried away; empty if it was not seen.
text::Message Api::move_since_start() const {
    const auto moved =
        survey::moved_box(sources_.occupations, sources_.live, sources_.status().now);
    if (!moved || moved->is_at_start || moved->is_set_up) return {};
    const std::string time = to_rfc3339(moved->time, 0);
    return text::message("; the box was moved at {}: a351ctl stop --at {}", time, time);
}

/// Says that the operator has looked at the contradiction that the signal shows.
survey::Outcome Api::check(const Order& order) const {
    const status::Status status = sources_.status();
    const auto field = survey::field_status(sources_.occupations, sources_.live, status.now);
    const auto open = survey::open_contradictions(status, sources_.occupations, field.moved,
                                                  field.face, so_far_now());
    const bool is_shown = !open.empty() &&
                          std::ranges::count(open.front().buttons, survey::kChecked) > 0 &&
                          (order.code.empty() || order.code == open.front().code) &&
                          (order.key.empty() || order.key == open.front().key);
    if (is_shown) return sources_.occupations.check(open.front());
    if (open.empty())
        return {survey::Outcome::Kind::refused, text::message("there is no LOOK to answer")};
    return {survey::Outcome::Kind::refused,
            text::message("the signal shows something else by now; nothing was changed")};
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
    if (change == "resume") {
        if (const auto missing = missing_samples(); !missing.empty())
            return {survey::Outcome::Kind::refused, missing};
        return occupations.resume(stay, order.remark);
    }
    if (change == "not_moved") return occupations.not_moved(stay, order.remark);
    return occupations.retime(stay, order.from, order.to, order.remark);
}

}  // namespace a351::daemon::page
