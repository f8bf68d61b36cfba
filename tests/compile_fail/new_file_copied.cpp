// Law: two objects cannot write the same new file.
#include "protocol/text/new_file.hpp"

void write(a351::text::NewFile& file) {
#ifdef A351_LEGAL
    file.write("text");
#else
    a351::text::NewFile(file).write("text");
#endif
}
