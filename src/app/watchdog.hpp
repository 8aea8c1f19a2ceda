// Ends a run that hangs: a rank or a file system that no longer answers, for which all others would wait for
// ever.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "core/communicator.hpp"
#include "core/types.hpp"

namespace alphadot {

/// While it lives, a thread of each rank looks at a count that the rank's work keeps raising. When it has not
/// changed for `minutes`, the program is ended with a message and the exit code of an error; mpirun then ends
/// the other ranks. The root is the first to speak, so that one message is seen.
class Watchdog {
 public:
  /// `progress` is called by the thread. minutes = 0: no watch.
  Watchdog(Real minutes, std::function<GlobalIndex()> progress, const Communicator& comm);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void watch(Real minutes, int rank);

  std::function<GlobalIndex()> progress_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace alphadot
