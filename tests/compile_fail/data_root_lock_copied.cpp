// Law: the lock of a data root has one owner, so that two daemons cannot write to one root.
#include "daemon/store/data_root.hpp"

void use(a351::daemon::store::DataRootLock& lock) {
#ifdef A351_LEGAL
    a351::daemon::store::DataRootLock& same = lock;
#else
    a351::daemon::store::DataRootLock same = lock;
#endif
    static_cast<void>(same);
}
