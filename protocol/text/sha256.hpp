#pragma once
/// @file
/// The digest SHA-256 (FIPS 180-4), for bytes that come piece by piece.
///
///     Sha256 digest;
///     while (...) digest.update(piece);
///     text += digest.hex() + "  " + name + '\n';  // a line that sha256sum -c accepts
///
/// Programs that use this header link a351_input_file, which is a library of its own because it
/// needs Nettle.

#include <nettle/sha2.h>

#include <string>
#include <string_view>

namespace a351::text {

class Sha256 {
public:
    Sha256() { sha256_init(&state_); }
    void update(std::string_view bytes);
    /// Returns 64 lower-case hexadecimal digits, as the command sha256sum prints them, and begins a
    /// new digest.
    [[nodiscard]] std::string hex();

private:
    sha256_ctx state_{};
};

}  // namespace a351::text
