#include "partition/ordering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alphadot {

namespace {

/// x of every cell in steps far below any cell's size, so that round-off (of a change of units, say) does not
/// decide between cells at the same place.
std::vector<GlobalIndex> stations(std::span<const Vec3> center) {
  Real lowest = std::numeric_limits<Real>::infinity(), highest = -lowest;
  for (const Vec3& c : center) {
    lowest = std::min(lowest, c.x);
    highest = std::max(highest, c.x);
  }
  const Real steps = highest > lowest ? 1e9 / (highest - lowest) : 0;
  std::vector<GlobalIndex> out;
  out.reserve(center.size());
  for (const Vec3& c : center) out.push_back(std::llround((c.x - lowest) * steps));
  return out;
}

}  // namespace

std::vector<Index> downstream_order(const Adjacency& graph, std::span<const Vec3> center) {
  const Index count = static_cast<Index>(center.size());
  const auto upstream = [&, station = stations(center)](Index a, Index b) {
    return station[a] != station[b] ? station[a] < station[b] : a < b;
  };
  std::vector<Index> waiting_for(center.size(), 0);  // neighbours upstream that have no number yet
  for (Index cell = 0; cell < count; ++cell)
    for (const Index neighbour : graph[cell])
      if (neighbour < count && upstream(neighbour, cell)) ++waiting_for[cell];

  std::vector<Index> ready;  // a stack
  for (Index cell = 0; cell < count; ++cell)
    if (waiting_for[cell] == 0) ready.push_back(cell);
  std::sort(ready.begin(), ready.end(), [&](Index a, Index b) { return upstream(b, a); });

  std::vector<Index> order;
  order.reserve(center.size());
  while (!ready.empty()) {
    const Index cell = ready.back();
    ready.pop_back();
    order.push_back(cell);
    for (const Index neighbour : graph[cell])
      if (neighbour < count && upstream(cell, neighbour) && --waiting_for[neighbour] == 0)
        ready.push_back(neighbour);
  }
  return order;
}

}  // namespace alphadot
