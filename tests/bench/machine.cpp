#include "bench/machine.hpp"

#include <algorithm>
#include <array>
#include <experimental/simd>
#include <span>
#include <vector>

#include "core/timer.hpp"

namespace alphadot {

namespace {

/// Seconds of processor that the fastest of several runs of `work` took, on the rank where it took most; runs
/// begin on all ranks together. (Processor time, because others may use the machine too.)
template <class Work>
Real fastest(const Communicator& comm, int repeats, const Work& work) {
  Real best = 1e300;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    comm.barrier();
    const Timer time;
    work();
    best = std::min(best, comm.max(time.cpu()));
  }
  return best;
}

}  // namespace

Real triad_bandwidth(const Communicator& comm) {
  constexpr std::size_t size = 1 << 24;  // 128 MB an array
  std::vector<Real> a(size, 0), b(size, 1), c(size, 2);
  volatile Real factor = 3;
  const Real seconds = fastest(comm, 12, [&] {
    const Real s = factor;
    for (std::size_t i = 0; i < size; ++i) a[i] = b[i] + s * c[i];
  });
  return 24 * static_cast<Real>(size) / seconds;
}

Real peak_flops(const Communicator& comm) {
  using Lanes = std::experimental::native_simd<Real>;
  constexpr int chains = 16, rounds = 2'000'000;
  std::array<Lanes, chains> sums;
  volatile Real start = 1, factor = 0.999;
  sums.fill(start);
  const Real seconds = fastest(comm, 8, [&] {
    const Lanes f = factor;
    for (int round = 0; round < rounds; ++round)
      for (auto& sum : sums) sum = sum * f + f;
  });
  Real keep = 0;
  for (const auto& sum : sums) keep += sum[0];
  start = keep;
  return 2.0 * chains * static_cast<Real>(Lanes::size()) * rounds / seconds;
}

MessageCost message_cost(const Communicator& comm) {
  if (comm.size() < 2) return {};
  const auto one_way = [&](int bytes, int trips) {
    std::vector<char> buffer(static_cast<std::size_t>(bytes));
    const Real seconds = fastest(comm, 8, [&] {
      for (int trip = 0; trip < trips && comm.rank() < 2; ++trip)
        for (int sender = 0; sender < 2; ++sender) {
          if (comm.rank() == sender)
            MPI_Send(buffer.data(), bytes, MPI_BYTE, 1 - sender, 0, comm.handle());
          else
            MPI_Recv(buffer.data(), bytes, MPI_BYTE, 1 - comm.rank(), 0, comm.handle(), MPI_STATUS_IGNORE);
        }
    });
    return seconds / (2 * trips);
  };
  constexpr int large = 1 << 22;
  return {one_way(8, 200), large / one_way(large, 10)};
}

Real reduction_seconds(const Communicator& comm) {
  constexpr int trips = 100;
  std::vector<Real> buffer(64, 1);
  return fastest(comm, 8,
                 [&] {
                   for (int trip = 0; trip < trips; ++trip) {
                     std::fill(buffer.begin(), buffer.end(), 1);
                     comm.sum(std::span<Real>(buffer));
                   }
                 }) /
         trips;
}

}  // namespace alphadot
