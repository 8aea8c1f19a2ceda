#include "partition/ordering.hpp"

#include <algorithm>

namespace alphadot {

std::vector<Index> downstream_order(const Adjacency& graph, std::span<const Vec3> center) {
  const Index count = static_cast<Index>(center.size());
  const auto upstream = [&](Index a, Index b) {
    return center[a].x != center[b].x ? center[a].x < center[b].x : a < b;
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
