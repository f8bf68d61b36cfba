#include "daemon/page/guard.hpp"

#include <fmt/core.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace a351::daemon::page {
namespace {

constexpr std::string_view kHttp = "http://", kHttps = "https://";

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

bool has_port(std::string_view host) {
    const auto colon = host.rfind(':');
    return colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos;
}

/// Returns a host without the port that browsers leave out: 80 of http, 443 of https.
std::string without_usual_port(std::string_view scheme, std::string_view host) {
    const std::string_view usual = scheme == kHttps ? ":443" : ":80";
    if (host.ends_with(usual)) host.remove_suffix(usual.size());
    return std::string(host);
}

/// Returns true for application/json, with or without parameters.
bool is_json(std::string_view content_type) {
    const std::string type = lower(content_type.substr(0, content_type.find(';')));
    const auto end = type.find_last_not_of(" \t");
    return end != std::string::npos && type.substr(0, end + 1) == "application/json";
}

bool asks_for_stream(const Request& request) {
    return std::ranges::any_of(request.values("Upgrade"), [](const std::string& protocol) {
        return lower(protocol).find("websocket") != std::string::npos;
    });
}

/// Returns true for an origin on the browser's own computer.
bool is_loopback(std::string_view origin) {
    const auto mark = origin.find("://");
    if (mark == std::string_view::npos) return false;
    const auto host = origin.substr(mark + 3);
    const auto name = host.substr(0, has_port(host) ? host.rfind(':') : host.size());
    return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

/// Compares two texts in a time that does not depend on where they differ.
bool is_same_secret(std::string_view given, std::string_view expected) noexcept {
    if (given.size() != expected.size() || expected.empty()) return false;
    volatile unsigned char difference = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        difference = static_cast<unsigned char>(difference | (given[i] ^ expected[i]));
    return difference == 0;
}

/// Returns true for /api/token and the pages, which have the token in them for a local client.
bool shows_token(std::string_view target) {
    const auto path = target.substr(0, target.find('?'));
    return !path.starts_with("/api/") || path == "/api/token";
}

}  // namespace

Guard::Guard(std::uint16_t port, const std::vector<std::string>& hosts, std::string token,
             const std::vector<std::string>& boxes)
    : token_(std::move(token)) {
    for (const std::string& box : boxes) {
        const auto host = box.find("://") + 3;
        const std::string scheme = lower(box.substr(0, host));
        boxes_.push_back(scheme + without_usual_port(scheme, lower(box.substr(host))));
    }
    const std::string suffix = fmt::format(":{}", port);
    for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) add(kHttp, name + suffix);
    for (const auto& given : hosts) {
        const std::string host = lower(given);
        if (host.starts_with(kHttps))
            add(kHttps, host.substr(kHttps.size()));
        else if (host.starts_with(kHttp))
            add(kHttp, host.substr(kHttp.size()));
        else
            add(kHttp, has_port(host) ? host : host + suffix);
    }
}

void Guard::add(std::string_view scheme, const std::string& host) {
    for (const std::string& name : {host, without_usual_port(scheme, host)}) {
        hosts_.push_back(name);
        origins_.push_back(std::string(scheme) + name);
    }
}

std::optional<Response> Guard::refuse(const Request& request) const {
    const auto is_own_address = [&](std::string_view name) {
        return !request.address.empty() &&
               (name == request.address || name == without_usual_port(kHttp, request.address));
    };
    const auto is_listed = [&](std::string_view host) {
        const std::string name = lower(host);
        return std::ranges::count(hosts_, name) > 0 || is_own_address(name);
    };
    const auto is_own_origin = [&](std::string_view given) {
        const std::string origin = lower(given);
        return std::ranges::count(origins_, origin) > 0 ||
               (origin.starts_with(kHttp) && is_own_address(origin.substr(kHttp.size())));
    };
    const auto host = request.values("Host");
    if (host.size() != 1 || !is_listed(host.front()))
        return refusal(421, "Host is not a name of this daemon; add it to [page] hosts");
    if (auto response = allow_box(request)) return response;
    const auto box = box_of(request);
    if (box && !is_own_origin(*box) && !is_loopback(lower(*box)) && shows_token(request.target))
        return refusal(403, "the page of another box may read /api only, without the token");
    const bool is_read = request.method == "GET" || request.method == "HEAD";
    const bool is_stream = asks_for_stream(request);
    if (is_read && !is_stream) return std::nullopt;

    const auto origins = request.values("Origin");
    for (const auto& origin : origins) {
        if (!is_own_origin(origin) && std::ranges::count(boxes_, lower(origin)) == 0)
            return refusal(403, "Origin is not a name of this daemon");
    }
    if (is_read && !origins.empty()) return std::nullopt;
    const auto type = request.values("Content-Type");
    if (!is_read && (type.size() != 1 || !is_json(type.front())))
        return refusal(403, "Content-Type must be application/json");
    const auto token = request.values("X-A351-Token");
    if (token.size() != 1 || !is_same_secret(token.front(), token_))
        return refusal(403, "the token (header X-A351-Token) is missing or wrong");
    return std::nullopt;
}

std::optional<std::string> Guard::box_of(const Request& request) const {
    const auto origins = request.values("Origin");
    if (origins.size() != 1 || std::ranges::count(boxes_, lower(origins.front())) == 0)
        return std::nullopt;
    return origins.front();
}

std::optional<Response> Guard::allow_box(const Request& request) const {
    const auto box = box_of(request);
    if (request.method != "OPTIONS" || !box) return std::nullopt;
    return Response{.body = "",
                    .headers = {{"Access-Control-Allow-Methods", "GET, POST"},
                                {"Access-Control-Allow-Headers", "content-type, x-a351-token"}}};
}

void Guard::show_box(const Request& request, Response& response) const {
    if (boxes_.empty()) return;
    response.headers.emplace_back("Vary", "Origin");
    if (const auto box = box_of(request))
        response.headers.emplace_back("Access-Control-Allow-Origin", *box);
}

std::string random_token() {
    std::array<unsigned char, 32> bytes{};
    for (std::size_t filled = 0; filled < bytes.size();) {
        const auto got = getrandom(bytes.data() + filled, bytes.size() - filled, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw std::system_error(errno, std::generic_category(), "getrandom");
        filled += static_cast<std::size_t>(got);
    }
    std::string text;
    for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

const std::vector<std::pair<std::string, std::string>>& security_headers() {
    static const std::vector<std::pair<std::string, std::string>> kHeaders = {
        {"Content-Security-Policy",
         "default-src 'self'; script-src 'self'; style-src 'self'; object-src 'none'; "
         "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
        {"X-Frame-Options", "DENY"},
        {"X-Content-Type-Options", "nosniff"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Referrer-Policy", "no-referrer"},
        {"Cache-Control", "no-store"}};
    return kHeaders;
}

}  // namespace a351::daemon::page
