#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "daemon/page/message.hpp"

namespace a351::daemon {

/// A file of the page, compiled in; the list is that of CMakeLists.txt.
struct Asset {
    std::string_view name;
    std::string_view bytes;
};
[[nodiscard]] std::span<const Asset> compiled_assets() noexcept;

/// The files of the page: index.html at /, the others at /NAME.
class Assets {
public:
    /// @param directory  where they are read anew for each request; empty: those compiled in, as is
    ///                   one that is not there.  Other names than the compiled ones are not served.
    /// @param token      put in place of @TOKEN@ in index.html.
    Assets(std::filesystem::path directory, std::string_view token);

    [[nodiscard]] bool contains(std::string_view path) const noexcept;
    [[nodiscard]] Response answer(std::string_view path) const;  ///< contains(path)

private:
    std::filesystem::path directory_;
    std::string token_;  ///< As HTML.
};

}  // namespace a351::daemon
