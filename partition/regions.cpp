#include "partition/regions.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "partition/delivery.hpp"
#include "partition/disjoint_sets.hpp"
#include "partition/halo.hpp"

namespace alphadot {

namespace {

void add(Region& region, const Region& part) {
  region.cells += part.cells;
  region.first_cell = std::min(region.first_cell, part.first_cell);
  extend(region.box, part.box);
}

/// What this rank's cells fall into, without regard to the cells of other ranks.
struct Pieces {
  std::vector<Region> all;
  std::vector<Index> of_cell;  ///< [owned_cells]
};

Pieces pieces_of(const Subdomain& domain) {
  DisjointSets sets(static_cast<std::size_t>(domain.owned_cells));
  for (Index face = 0; face < domain.cut_face_begin; ++face)
    sets.join(domain.faces[face].left, domain.faces[face].right);
  Pieces out{{}, sets.numbers()};
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const Index piece = out.of_cell[cell];
    if (piece == static_cast<Index>(out.all.size())) out.all.emplace_back();
    Region alone{1, domain.cell_ids[cell], empty_box()};
    for (const Index point : domain.cell_points[cell]) extend(alone.box, domain.points[point]);
    add(out.all[piece], alone);
  }
  return out;
}

/// Two pieces, by their first cells, that share a face across a cut.
struct Link {
  GlobalIndex a, b;
  auto operator<=>(const Link&) const = default;
};

std::vector<Link> links_of(const Subdomain& domain, const Pieces& pieces, const Communicator& comm) {
  std::vector<GlobalIndex> first(static_cast<std::size_t>(domain.total_cells), 0);
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    first[cell] = pieces.all[pieces.of_cell[cell]].first_cell;
  HaloExchange<GlobalIndex>(domain, comm, first, HaloWidth::faces).exchange();
  std::vector<Link> out;
  for (std::size_t face = static_cast<std::size_t>(domain.cut_face_begin); face < domain.faces.size(); ++face)
    out.push_back({first[domain.faces[face].left], first[domain.faces[face].right]});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// All of `items` to the root.
template <class T>
Delivery<T> to_root(std::span<const T> items, const Communicator& comm) {
  std::vector<int> counts(static_cast<std::size_t>(comm.size()), 0);
  counts[0] = item_count(items.size());
  return deliver<T>(items, counts, comm);
}

/// Joins the pieces of all ranks; returns the position of each piece's region in `regions`.
std::vector<Index> join(std::span<const Region> pieces, std::span<const Link> links,
                        std::vector<Region>& regions) {
  std::vector<std::pair<GlobalIndex, Index>> by_first_cell;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    by_first_cell.emplace_back(pieces[i].first_cell, static_cast<Index>(i));
  std::sort(by_first_cell.begin(), by_first_cell.end());
  const auto piece_at = [&](GlobalIndex first_cell) {
    return std::lower_bound(by_first_cell.begin(), by_first_cell.end(), std::pair{first_cell, Index{0}})
        ->second;
  };
  DisjointSets sets(pieces.size());
  for (const auto& [a, b] : links) sets.join(piece_at(a), piece_at(b));
  auto set_of = sets.numbers();
  std::vector<Region> joined;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (set_of[i] == static_cast<Index>(joined.size())) joined.emplace_back();
    add(joined[set_of[i]], pieces[i]);
  }
  std::vector<Index> order(joined.size()), place(joined.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tuple(-joined[a].cells, joined[a].first_cell) <
           std::tuple(-joined[b].cells, joined[b].first_cell);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    regions.push_back(joined[order[i]]);
    place[order[i]] = static_cast<Index>(i);
  }
  for (Index& set : set_of) set = place[set];
  return set_of;
}

}  // namespace

Regions find_regions(const Subdomain& domain, const Communicator& comm) {
  const Pieces pieces = pieces_of(domain);
  const auto links = to_root<Link>(links_of(domain, pieces, comm), comm);
  const auto gathered = to_root<Region>(pieces.all, comm);
  Regions out;
  std::vector<Index> region_of_piece;
  if (comm.is_root()) region_of_piece = join(gathered.items, links.items, out.all);
  region_of_piece =
      deliver<Index>(
          region_of_piece,
          comm.is_root() ? gathered.counts : std::vector<int>(static_cast<std::size_t>(comm.size()), 0), comm)
          .items;
  out.all.resize(static_cast<std::size_t>(comm.sum(static_cast<GlobalIndex>(out.all.size()))));
  comm.broadcast(std::as_writable_bytes(std::span(out.all)));
  out.of_cell.reserve(pieces.of_cell.size());
  for (const Index piece : pieces.of_cell) out.of_cell.push_back(region_of_piece[piece]);
  return out;
}

}  // namespace alphadot
