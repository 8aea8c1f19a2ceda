// What the machine can do at most: bandwidth, arithmetic, messages.
#pragma once

#include "core/communicator.hpp"
#include "core/types.hpp"

namespace alphadot {

/// Bytes a second and rank of a = b + s c over arrays far larger than the caches, all ranks at once; 24 bytes
/// an element, as STREAM counts (McCalpin 1995). The best of several.
Real triad_bandwidth(const Communicator& comm);

/// Fused multiply-adds on vectors in registers, each two operations an element: flops a second and rank, all
/// ranks at once.
Real peak_flops(const Communicator& comm);

/// Between ranks 0 and 1; zero on one rank.
struct MessageCost {
  Real latency = 0;    ///< seconds
  Real bandwidth = 0;  ///< bytes a second
};
MessageCost message_cost(const Communicator& comm);

/// Seconds of one all-reduce of a report's length.
Real reduction_seconds(const Communicator& comm);

}  // namespace alphadot
