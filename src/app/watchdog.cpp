#include "app/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "core/run_status.hpp"

namespace alphadot {

Watchdog::Watchdog(Real minutes, std::function<GlobalIndex()> progress, const Communicator& comm)
    : progress_(std::move(progress)) {
  if (minutes > 0) thread_ = std::thread([this, minutes, rank = comm.rank()] { watch(minutes, rank); });
}

Watchdog::~Watchdog() {
  {
    const std::scoped_lock lock(mutex_);
    is_over_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Watchdog::watch(Real minutes, int rank) {
  using Seconds = std::chrono::duration<Real>;
  const Seconds allowed(60 * minutes + std::min(rank, 10));  // a second for mpirun to end the others
  const Seconds between_looks = std::min(Seconds(1), allowed / 4);
  // Time by looks, so that a program that was itself stopped and goes on does not count as hanging.
  Seconds silent(0);
  GlobalIndex last = progress_();
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, between_looks, [this] { return is_over_; })) {
    const auto count = progress_();
    silent = count == last ? silent + between_looks : Seconds(0);
    last = count;
    if (silent < allowed) continue;
    // Not MPI_Abort: the rank's own thread may be inside MPI for ever.
    fmt::print(
        stderr,
        "alphadot: error: no iteration has ended for {} minutes (checkpoint.watchdog_minutes): the run "
        "hangs and is given up; seen by rank {}\n",
        minutes, rank);
    std::fflush(stderr);
    std::_Exit(exit_code(RunStatus::error));
  }
}

}  // namespace alphadot
