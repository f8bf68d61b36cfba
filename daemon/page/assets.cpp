#include "daemon/page/assets.hpp"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "daemon/page/guard.hpp"
#include "protocol/text/catalogue.hpp"

namespace a351::daemon::page {
namespace {

constexpr std::string_view kIndex = "index.html";
constexpr std::string_view kBoxesPage = "boxes.html";
constexpr std::string_view kTokenMark = "@TOKEN@", kBoxesMark = "@BOXES@",
                           kLanguagesMark = "@LANGUAGES@", kConfiguredMark = "@CONFIGURED@";

const Asset* find(std::string_view path) noexcept {
    if (!path.starts_with('/')) return nullptr;
    const auto name = path == "/" ? kIndex : path == "/boxes" ? kBoxesPage : path.substr(1);
    const auto assets = compiled_assets();
    const auto found = std::ranges::find(assets, name, &Asset::name);
    return found == assets.end() ? nullptr : &*found;
}

std::string content_type(std::string_view name) {
    if (name.ends_with(".html")) return "text/html; charset=utf-8";
    if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
    if (name.ends_with(".css")) return "text/css; charset=utf-8";
    if (name.ends_with(".svg")) return "image/svg+xml";
    return "application/octet-stream";
}

void replace(std::string& page, std::string_view mark, std::string_view text) {
    if (const auto at = page.find(mark); at != std::string::npos)
        page.replace(at, mark.size(), text);
}

/// Escapes a text for HTML: a configured token may contain any visible character.
std::string as_html(std::string_view text) {
    std::string html;
    for (const char& c : text) {
        html += c == '&'   ? "&amp;"
                : c == '<' ? "&lt;"
                : c == '"' ? "&quot;"
                           : std::string_view(&c, 1);
    }
    return html;
}

/// Returns the names of the languages by their codes, as JSON.
std::string languages() {
    nlohmann::json names = {{text::Language::english.code, name_of(text::Language::english)}};
    for (const text::Language& one : text::other_languages())
        names[std::string(one.code)] = name_of(one);
    return names.dump();
}

}  // namespace

Assets::Assets(std::filesystem::path directory, std::string_view token,
               const std::vector<std::string>& boxes, bool is_token_configured)
    : directory_(std::move(directory)),
      token_(as_html(token)),
      is_token_configured_(is_token_configured) {
    for (const std::string& box : boxes) boxes_ += (boxes_.empty() ? "" : " ") + box;
}

bool Assets::contains(std::string_view path) const noexcept { return find(path) != nullptr; }

Response Assets::answer(std::string_view path, bool is_local) const {
    const Asset* const asset = find(path);
    assert(asset);
    Response response;
    response.content_type = content_type(asset->name);
    response.body = asset->bytes;
    if (!directory_.empty()) {
        if (std::ifstream file(directory_ / asset->name, std::ios::binary); file)
            response.body.assign(std::istreambuf_iterator<char>(file), {});
    }
    const bool is_overview = asset->name == kBoxesPage;
    if (is_overview) replace(response.body, kConfiguredMark, is_token_configured_ ? "yes" : "");
    if (asset->name == kIndex || is_overview) {
        replace(response.body, kBoxesMark, boxes_);
        replace(response.body, kLanguagesMark, as_html(languages()));
        replace(response.body, kTokenMark, is_local ? token_ : std::string());
    }
    if (!is_overview) return response;
    for (const auto& [name, value] : security_headers())
        if (name == "Content-Security-Policy")
            response.headers.emplace_back(name, value + "; connect-src 'self' " + boxes_);
    return response;
}

}  // namespace a351::daemon::page
