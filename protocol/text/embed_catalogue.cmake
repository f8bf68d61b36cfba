# Writes OUTPUT, a C++ source that defines compiled_catalogue() with the bytes of MO.
file(READ ${MO} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"protocol/text/compiled_catalogue.hpp\"

namespace a351::text {
namespace {

constexpr unsigned char kBytes[] = {${bytes}};

}  // namespace

std::string_view compiled_catalogue() noexcept {
    return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

}  // namespace a351::text
")
