// Law: a serial port has one owner, which closes it.
#include "daemon/source/tty_port.hpp"

void use(a351::daemon::source::TtyPort& port) {
#ifdef A351_LEGAL
    a351::daemon::source::TtyPort& same = port;
#else
    a351::daemon::source::TtyPort same = port;
#endif
    static_cast<void>(same);
}
