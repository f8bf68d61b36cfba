# Writes OUTPUT, a C++ source that defines other_languages() with CODE.mo of each of CODES (separated by commas).
set(source "#include \"protocol/text/catalogue.hpp\"\n\nnamespace a351::text {\nnamespace {\n\n")
set(table "")
string(REPLACE "," ";" CODES "${CODES}")
foreach(code IN LISTS CODES)
  file(READ ${code}.mo bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND source "constexpr unsigned char kBytes_${code}[] = {${bytes}};\n")
  string(APPEND table "        {\"${code}\", {reinterpret_cast<const char*>(kBytes_${code}), sizeof kBytes_${code}}},\n")
endforeach()
file(WRITE ${OUTPUT} "${source}
}  // namespace

std::span<const Language> other_languages() noexcept {
    static const Language kLanguages[] = {
${table}    };
    return kLanguages;
}

}  // namespace a351::text
")
