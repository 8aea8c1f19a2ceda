// CGNS files of mixed elements, written through the CGNS library.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/cgns/cgns_file.hpp"
#include "io/readers/mesh_writers.hpp"
#include "support/mixed_mesh.hpp"

namespace alphadot::test {

using ElementType = CGNS_ENUMT(ElementType_t);

struct CgnsDialect {
  bool is_mixed = false;   ///< one section for all volumes and one for each side
  bool is_curved = false;  ///< of second order
  bool has_families = false;
};

inline ElementType type_of(Shape shape, bool is_curved) {
  constexpr std::array first{CGNS_ENUMV(TRI_3),  CGNS_ENUMV(QUAD_4),  CGNS_ENUMV(TETRA_4),
                             CGNS_ENUMV(PYRA_5), CGNS_ENUMV(PENTA_6), CGNS_ENUMV(HEXA_8)},
      second{CGNS_ENUMV(TRI_6),   CGNS_ENUMV(QUAD_9),   CGNS_ENUMV(TETRA_10),
             CGNS_ENUMV(PYRA_13), CGNS_ENUMV(PENTA_15), CGNS_ENUMV(HEXA_27)};
  return (is_curved ? second : first)[static_cast<std::size_t>(shape)];
}

/// The corners, then as many nodes as the type has besides: a point of the file that no corner is.
inline std::vector<cgsize_t> nodes_of(const MixedElement& element, ElementType type, cgsize_t middle) {
  int nodes = 0;
  check(cg_npe(type, &nodes));
  std::vector<cgsize_t> out(element.corners.begin(), element.corners.end());
  out.resize(static_cast<std::size_t>(nodes), middle);
  return out;
}

inline void write_cgns(const std::string& path, const MixedMesh& mixed, const CgnsDialect& dialect) {
  CgnsFile file(path);
  Mesh points;
  points.points = mixed.points;
  const auto middle = static_cast<cgsize_t>(points.points.size());
  if (dialect.is_curved) points.points.push_back({0.5, 0.5, 0.5});
  file.add_zone(points);
  const auto put = [&](const std::string& name, const std::vector<MixedElement>& elements) {
    if (dialect.is_mixed) {
      std::vector<std::vector<cgsize_t>> typed;
      for (const auto& element : elements) {
        const auto type = type_of(element.shape, dialect.is_curved);
        auto& entry = typed.emplace_back(std::vector{static_cast<cgsize_t>(type)});
        for (const auto node : nodes_of(element, type, middle)) entry.push_back(node + 1);
      }
      file.add_mixed_section(name, typed);
      return;
    }
    for (const Shape shape : {Shape::hexahedron, Shape::triangle, Shape::tetrahedron, Shape::pyramid,
                              Shape::quadrilateral, Shape::prism}) {
      const auto type = type_of(shape, dialect.is_curved);
      std::vector<std::vector<cgsize_t>> nodes;
      for (const auto& element : elements)
        if (element.shape == shape) nodes.push_back(nodes_of(element, type, middle));
      // Sections have names of their own; what belongs together is told by a family then.
      if (!nodes.empty()) file.add_section(name + " " + cg_ElementTypeName(type), type, nodes);
    }
  };
  put("air", mixed.volumes);
  for (std::size_t i = 0; i < mixed.sides.size(); ++i) {
    const cgsize_t first = file.next();
    const std::string name = side_names[i];
    put(dialect.has_families ? "side " + std::to_string(i) : name, mixed.sides[i]);
    if (dialect.has_families)
      file.add_condition("condition " + std::to_string(i), CGNS_ENUMV(PointRange), {first, file.next() - 1},
                         name);
  }
}

}  // namespace alphadot::test
