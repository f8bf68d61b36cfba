// Law: a pseudo-terminal has one owner, which removes its link.
#include "sim/line/pty.hpp"

void use(a351::sim::line::Pty& pty) {
#ifdef A351_LEGAL
    a351::sim::line::Pty& same = pty;
#else
    a351::sim::line::Pty same = pty;
#endif
    static_cast<void>(same);
}
