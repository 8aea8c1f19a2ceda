#include "partition/ordering.hpp"

#include <algorithm>
#include <numeric>

namespace alphadot {

std::vector<Index> upstream_cuthill_mckee(const Adjacency& graph, std::span<const Vec3> center) {
  const Index count = static_cast<Index>(center.size());
  const auto x = [&](Index cell) { return center[cell].x; };
  const auto degree = [&](Index cell) { return graph.begin[cell + 1] - graph.begin[cell]; };

  std::vector<Index> seeds(center.size());
  std::iota(seeds.begin(), seeds.end(), 0);
  std::sort(seeds.begin(), seeds.end(), [&](Index a, Index b) { return x(a) != x(b) ? x(a) < x(b) : a < b; });

  std::vector<Index> order;
  order.reserve(center.size());
  std::vector<char> numbered(center.size(), 0);
  const auto number = [&](Index cell) {
    numbered[cell] = 1;
    order.push_back(cell);
  };
  std::size_t next = 0;
  for (const Index seed : seeds) {  // more than one is used only where the part is in several pieces
    if (numbered[seed]) continue;
    number(seed);
    for (; next < order.size(); ++next) {
      const auto first = static_cast<std::ptrdiff_t>(order.size());
      for (const Index neighbour : graph[order[next]])
        if (neighbour < count && !numbered[neighbour]) number(neighbour);
      std::sort(order.begin() + first, order.end(),
                [&](Index a, Index b) { return degree(a) != degree(b) ? degree(a) < degree(b) : a < b; });
    }
  }
  return order;
}

}  // namespace alphadot
