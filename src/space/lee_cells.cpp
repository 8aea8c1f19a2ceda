#include "space/lee_cells.hpp"

#include <algorithm>

#include "partition/aft_faces.hpp"
#include "space/flow_field.hpp"

namespace alphadot {

namespace {

using Marks = CellField<std::uint8_t>;

/// Marks the corners of owned cells that lie on walls facing aft, one bit each.
void mark_aft_corners(const Discretization& discretization, Marks& out) {
  const Subdomain& domain = discretization.domain();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const BoundaryFace& face = domain.boundary_faces[i];
    const BoundaryKind kind = discretization.kind_of(face);
    const bool is_wall = kind == BoundaryKind::wall || kind == BoundaryKind::sting;
    if (!is_wall || !looks_aft(domain.boundary_normal[i])) continue;
    for (unsigned corner = 0; corner < 4; ++corner)
      if (std::ranges::find(face.points, domain.cell_points[face.cell][corner]) != face.points.end())
        out[face.cell] = static_cast<std::uint8_t>(out[face.cell] | 1u << corner);
  }
}

}  // namespace

std::vector<std::uint8_t> lee_cells(const Discretization& discretization, const Communicator& comm) {
  const Subdomain& domain = discretization.domain();
  std::vector<bool> is_on_aft_wall(domain.points.size(), false);
  Marks corners(domain, comm);
  mark_aft_corners(discretization, corners);
  corners.exchange();
  for (Index cell = 0; cell < domain.total_cells; ++cell)
    for (unsigned corner = 0; corner < 4; ++corner)
      if (corners[cell] >> corner & 1u)
        is_on_aft_wall[static_cast<std::size_t>(domain.cell_points[cell][corner])] = true;
  Marks out(domain, comm);
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (const Index point : domain.cell_points[cell])
      if (is_on_aft_wall[static_cast<std::size_t>(point)] && domain.center[cell].x > domain.points[point].x)
        out[cell] = 1;
  out.exchange();
  return {out.values().begin(), out.values().end()};
}

}  // namespace alphadot
