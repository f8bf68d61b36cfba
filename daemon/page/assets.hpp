#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/page/message.hpp"

namespace a351::daemon::page {

/// A compiled file of the page; CMakeLists.txt has the list.
struct Asset {
    std::string_view name;
    std::string_view bytes;
};
[[nodiscard]] std::span<const Asset> compiled_assets() noexcept;

/// The files of the page: index.html at /, boxes.html at /boxes, the others at /NAME.
class Assets {
public:
    /// @param directory  the files are read from here for each request; if empty, or if a file does
    ///                   not exist, the compiled one is served.  Other names are not served.
    /// @param token      replaces @TOKEN@ in both pages for clients on this host.
    /// @param boxes      origins, which replace @BOXES@ in both pages, and to which boxes.html may
    ///                   connect.
    /// @param is_token_configured  replaces @CONFIGURED@ in boxes.html: a random token is not for
    ///                   other boxes.
    Assets(std::filesystem::path directory, std::string_view token,
           const std::vector<std::string>& boxes = {}, bool is_token_configured = false);

    [[nodiscard]] bool contains(std::string_view path) const noexcept;
    /// Answers a path that contains() has confirmed.
    [[nodiscard]] Response answer(std::string_view path, bool is_local) const;

private:
    std::filesystem::path directory_;
    std::string token_;  ///< Token, escaped for HTML.
    std::string boxes_;  ///< Origins, separated by spaces.
    bool is_token_configured_;
};

}  // namespace a351::daemon::page
