// Sums at points that several ranks know.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "partition/delivery.hpp"

namespace alphadot {

/// Of the parts that ranks have of what belongs to points, by their global ids, the sums over ranks, in the
/// order of `parts`; in the order of ranks, so that every rank has the same to the last bit. T adds up by +=.
/// Collective.
template <class T>
std::vector<T> sum_at_points(std::span<const GlobalIndex> ids, std::span<const T> parts,
                             const Communicator& comm) {
  struct Sum {
    GlobalIndex id;
    T value;
  };
  const auto addressed = address(
      parts.size(), [&](std::size_t i) { return static_cast<int>(ids[i] % comm.size()); }, comm);
  std::vector<Sum> sent;
  sent.reserve(parts.size());
  for (const Index i : addressed.order)
    sent.push_back({ids[static_cast<std::size_t>(i)], parts[static_cast<std::size_t>(i)]});
  auto delivery = deliver<Sum>(sent, addressed.counts, comm);
  auto& here = delivery.items;
  std::vector<std::size_t> order(here.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return here[i].id; });
  for (auto first = order.begin(); first != order.end();) {
    Sum total = here[*first];
    auto last = first + 1;
    for (; last != order.end() && here[*last].id == total.id; ++last) total.value += here[*last].value;
    for (; first != last; ++first) here[*first] = total;
  }
  const auto answers = deliver<Sum>(here, delivery.counts, comm).items;
  std::vector<T> out(parts.size());
  for (std::size_t i = 0; i < answers.size(); ++i)
    out[static_cast<std::size_t>(addressed.order[i])] = answers[i].value;
  return out;
}

}  // namespace alphadot
