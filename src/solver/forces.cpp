#include "solver/forces.hpp"

#include "core/dual.hpp"

namespace alphadot {

std::vector<Real> numbers_of(std::span<const Load> loads) {
  std::vector<Real> out;
  out.reserve(6 * loads.size());
  for (const Load& load : loads)
    for (const Vec3& part : {load.force, load.moment}) out.insert(out.end(), {part.x, part.y, part.z});
  return out;
}

std::vector<Load> loads_of(std::span<const Real> numbers) {
  std::vector<Load> out;
  for (auto n = numbers.begin(); n != numbers.end(); n += 6)
    out.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  return out;
}

Load total_of(std::span<const Load> loads) {
  Load out;
  for (const Load& load : loads) out += load;
  return out;
}

template <class T>
std::vector<LoadOf<T>> wall_loads(const Discretization& discretization, const Residual<T>& residual,
                                  const Vec3& center) {
  const Subdomain& domain = discretization.domain();
  const Real free_stream_pressure = 1 / discretization.gamma();
  std::vector<LoadOf<T>> loads(domain.patch_names.size());
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    if (discretization.kind_of(face) != BoundaryKind::wall) continue;
    const Vec3 at = domain.boundary_center[i];
    const auto force = (residual.boundary_pressures()[i] - free_stream_pressure) * domain.boundary_normal[i];
    loads[face.patch] += LoadOf<T>{force, cross(at - center, force)};
  }
  return loads;
}

template std::vector<Load> wall_loads(const Discretization&, const Residual<Real>&, const Vec3&);
template std::vector<LoadOf<Dual<1>>> wall_loads(const Discretization&, const Residual<Dual<1>>&,
                                                 const Vec3&);
template std::vector<LoadOf<Dual<2>>> wall_loads(const Discretization&, const Residual<Dual<2>>&,
                                                 const Vec3&);
template std::vector<LoadOf<Dual<3>>> wall_loads(const Discretization&, const Residual<Dual<3>>&,
                                                 const Vec3&);

}  // namespace alphadot
