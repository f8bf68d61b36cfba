// Preloaded into a program, shows it a machine of A351_CORES cores.  std::thread asks get_nprocs().
#include <sys/sysinfo.h>

#include <cstdlib>

int get_nprocs() noexcept { return std::atoi(std::getenv("A351_CORES")); }
