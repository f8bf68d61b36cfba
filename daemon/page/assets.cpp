#include "daemon/page/assets.hpp"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>

namespace a351::daemon::page {
namespace {

constexpr std::string_view kIndex = "index.html";
constexpr std::string_view kTokenMark = "@TOKEN@";

const Asset* find(std::string_view path) noexcept {
    if (!path.starts_with('/')) return nullptr;
    const auto name = path == "/" ? kIndex : path.substr(1);
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

}  // namespace

Assets::Assets(std::filesystem::path directory, std::string_view token)
    : directory_(std::move(directory)), token_(as_html(token)) {}

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
    if (const auto at = response.body.find(kTokenMark);
        asset->name == kIndex && at != std::string::npos)
        response.body.replace(at, kTokenMark.size(), is_local ? token_ : std::string());
    return response;
}

}  // namespace a351::daemon::page
