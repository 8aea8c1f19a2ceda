#include "partition/aft_faces.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace alphadot {

namespace {

/// `values` in another order.
template <class T>
void put_in_order(std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> out;
  out.reserve(values.size());
  for (const std::size_t from : order) out.push_back(values[from]);
  values = std::move(out);
}

}  // namespace

bool looks_aft(const Vec3& area) {
  constexpr Real aft = 0.70710678118654752;  // cosine of 45 degrees
  return -area.x > aft * norm(area);
}

std::string aft_name(const std::string& patch) {
  return patch + "_aft";
}

Real part_aft_faces(Subdomain& domain, const std::string& name) {
  auto& names = domain.patch_names;
  const auto patch = static_cast<Index>(std::ranges::find(names, name) - names.begin()),
             last = static_cast<Index>(names.size());
  names.push_back(aft_name(name));
  Real area = 0;
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    if (domain.boundary_faces[i].patch != patch || !looks_aft(domain.boundary_normal[i])) continue;
    domain.boundary_faces[i].patch = last;
    area += norm(domain.boundary_normal[i]);
  }
  std::vector<std::size_t> order(domain.boundary_faces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return domain.boundary_faces[i].patch; });
  put_in_order(domain.boundary_faces, order);
  put_in_order(domain.boundary_normal, order);
  put_in_order(domain.boundary_center, order);
  return area;
}

}  // namespace alphadot
