// Memory of this process as the system counts it.
#pragma once

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "core/types.hpp"

namespace alphadot {

/// Bytes in memory now.
inline Real resident_bytes() {
  std::ifstream in("/proc/self/statm");
  Real pages = 0, resident = 0;
  in >> pages >> resident;
  return resident * static_cast<Real>(sysconf(_SC_PAGESIZE));
}

/// The most bytes in memory at any time so far.
inline Real peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<Real>(usage.ru_maxrss);
}

/// From now on freed memory stays with the process: solves that come and go ask for the same again, and a
/// page fresh from the system costs more than the work on its numbers.
inline void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_TOP_PAD, 64 << 20);
}

}  // namespace alphadot
