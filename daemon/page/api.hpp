#pragma once
/// @file
/// The HTTP interface: turns a request into a response.  No sockets, no threads.
///
/// GET  / and the other files of the page
/// GET  /api/status /api/rows /api/events?since=UTC /api/sites /api/occupations /api/survey /api/token
/// GET  /api/bundle, which the server sends piece by piece
/// GET  /api/history?channel=NAME&from=UTC&to=UTC&points=N /metrics
/// POST /api/occupation/start|stop|setup|discard|restore|resume|rename|retime /api/note
///      /api/sites, with a JSON object as body; a change of a stay names it by its key
///
/// An answer under /api is JSON; a refusal is {"error": one line}: 400 malformed, 403 and 421
/// security, 404 and 405 unknown path or method, 409 not allowed now, 500 not on disk or an
/// internal error.  GET changes nothing.

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/verdict_config.hpp"
#include "daemon/live/live_record.hpp"
#include "daemon/page/assets.hpp"
#include "daemon/page/message.hpp"
#include "daemon/page/metrics.hpp"
#include "daemon/page/order.hpp"
#include "daemon/status/status.hpp"
#include "daemon/survey/occupations.hpp"
#include "daemon/survey/so_far.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::page {

/// The sources of the answers.
struct ApiSources {
    std::function<status::Status()> status;
    survey::Occupations& occupations;
    live::Record& live;
    Degrees latitude = {}, longitude = {};  ///< Position of the base, where a day begins.
    std::function<std::vector<events::Event>()> events;  ///< The whole event log, in file order.
    std::function<std::string()> gravity_so_far = {};    ///< Body of GET /api/survey.
    std::function<survey::SoFar()> so_far = {};          ///< The same, read.
    std::function<Download()> bundle = {};               ///< File of GET /api/bundle.
    std::function<void()> changing = {};                 ///< Called before each change,
    std::function<void()> changed = {};                  ///< and after each that is on disk.
    std::filesystem::path assets = {};    ///< The page's files; empty: the compiled ones.
    std::vector<std::string> boxes = {};  ///< Origins of the daemons that /boxes shows.
    bool is_token_configured = false;     ///< The server sets it.

    Nanoseconds stale_after = config::kStaleAfter;  ///< See config::stale_after().
};

class Api {
public:
    /// @param token   the token for changes, which clients on this host may read.
    /// @param listen  address and port of the server, for them too.
    Api(ApiSources sources, std::string token, std::string listen = {});

    /// Answers a request that has passed the Guard.  An exception of a source becomes a 500.
    [[nodiscard]] Response answer(const Request& request) noexcept;

    /// Returns the text message of the live stream: the status, and its rows without those of the
    /// stay, for which the page has panels.  std::nullopt if a source failed.
    [[nodiscard]] std::optional<nlohmann::json> live_status() noexcept;

    /// Returns a text that changes when viewers must get the status at once: with level, verdict,
    /// link and occupation.  std::nullopt if a source failed.  It is cheap enough for ten calls a
    /// second, unlike live_status(), which goes through the data of the day.
    [[nodiscard]] std::optional<std::string> urgent_status() noexcept;

    /// Returns the server's counters, which /metrics shows.
    [[nodiscard]] PageUse& use() noexcept { return use_; }

private:
    [[nodiscard]] nlohmann::json status_now() const;
    [[nodiscard]] survey::SoFar so_far_now() const;
    [[nodiscard]] text::Message missing_samples() const;
    [[nodiscard]] text::Message move_since_start() const;
    [[nodiscard]] survey::Outcome check(const Order& order) const;
    [[nodiscard]] Response route(const Request& request);
    [[nodiscard]] Response read(std::string_view path, std::string_view query, bool is_local);
    [[nodiscard]] Response change(std::string_view path, const std::string& body);
    [[nodiscard]] survey::Outcome change_stay(std::string_view change, const std::string& body);
    [[nodiscard]] Response rows() const;
    [[nodiscard]] Response sites_around() const;
    [[nodiscard]] Response occupations_so_far() const;
    [[nodiscard]] Response events_since(std::string_view query);

    ApiSources sources_;
    std::string token_;
    std::string listen_;
    Assets assets_;
    PageUse use_;
};

}  // namespace a351::daemon::page
