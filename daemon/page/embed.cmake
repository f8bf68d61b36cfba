# Writes OUTPUT, a C++ source that defines compiled_assets() with the files of ASSETS (separated by |).
set(source "#include \"daemon/page/assets.hpp\"\n\nnamespace a351::daemon::page {\nnamespace {\n")
set(table "")
set(number 0)
string(REPLACE "|" ";" ASSETS "${ASSETS}")
foreach(file IN LISTS ASSETS)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  cmake_path(GET file FILENAME name)
  # The last byte is not served; it avoids an empty array for an empty file.
  string(APPEND source "\nconstexpr unsigned char kAsset${number}[] = {${bytes}0};\n")
  string(APPEND table "    {\"${name}\", text(kAsset${number}, sizeof kAsset${number} - 1)},\n")
  math(EXPR number "${number} + 1")
endforeach()
string(APPEND source "
std::string_view text(const unsigned char* bytes, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

std::span<const Asset> compiled_assets() noexcept {
    static const Asset kAssets[] = {
${table}    };
    return kAssets;
}

}  // namespace a351::daemon::page
")
file(WRITE ${OUTPUT} "${source}")
