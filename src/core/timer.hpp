// Wall-clock and processor time of a stretch of work.
#pragma once

#include <chrono>
#include <ctime>

#include "core/types.hpp"

namespace alphadot {

class Timer {
 public:
  /// Seconds on the wall since construction.
  Real wall() const { return std::chrono::duration<Real>(Clock::now() - start_).count(); }
  /// Seconds of this rank's processor since construction.
  Real cpu() const { return cpu_now() - cpu_start_; }

 private:
  using Clock = std::chrono::steady_clock;
  static Real cpu_now() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<Real>(now.tv_sec) + 1e-9 * static_cast<Real>(now.tv_nsec);
  }
  Clock::time_point start_ = Clock::now();
  Real cpu_start_ = cpu_now();
};

/// What work costs that comes again and again: seconds of this rank.
struct TimeSpent {
  Real wall = 0, cpu = 0;
  int times = 0;

  /// Counts the stretch that `timer` has measured up to now.
  void add(const Timer& timer) {
    wall += timer.wall();
    cpu += timer.cpu();
    ++times;
  }
};

}  // namespace alphadot
