#include "io/gmsh_reader_state.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace alphadot::gmsh {
namespace {

using enum ElementUse;

// Indexed by Gmsh's number less one: first and second order, all that its mesh generator makes by itself.
constexpr std::array<ElementType, 19> element_types{{{2, ignored, "lines"},
                                                     {3, triangle, "triangles"},
                                                     {4, refused, "quadrangles"},
                                                     {4, tetrahedron, "tetrahedra"},
                                                     {8, refused, "hexahedra"},
                                                     {6, refused, "prisms"},
                                                     {5, refused, "pyramids"},
                                                     {3, ignored, "second-order lines"},
                                                     {6, refused, "second-order triangles"},
                                                     {9, refused, "second-order quadrangles"},
                                                     {10, refused, "second-order tetrahedra"},
                                                     {27, refused, "second-order hexahedra"},
                                                     {18, refused, "second-order prisms"},
                                                     {14, refused, "second-order pyramids"},
                                                     {1, ignored, "points"},
                                                     {8, refused, "second-order quadrangles of 8 nodes"},
                                                     {20, refused, "second-order hexahedra of 20 nodes"},
                                                     {15, refused, "second-order prisms of 15 nodes"},
                                                     {13, refused, "second-order pyramids of 13 nodes"}}};

}  // namespace

const ElementType& State::element_type(int number) const {
  if (number < 1 || number > static_cast<int>(element_types.size()))
    in.fail("elements of Gmsh's type " + std::to_string(number) + " cannot be used, only linear tetrahedra",
            "mesh the volume with first-order tetrahedra only");
  return element_types[static_cast<std::size_t>(number - 1)];
}

std::string_view State::surface_name(GlobalIndex physical_tag) const {
  const GlobalIndex tag = std::abs(physical_tag);
  const auto found =
      std::lower_bound(surface_names.begin(), surface_names.end(), std::pair{tag, std::string_view{}});
  return found != surface_names.end() && found->first == tag ? found->second : std::string_view{};
}

GlobalIndex State::point_of(GlobalIndex node_tag) const {
  const GlobalIndex point = nodes.find(node_tag);
  if (point < 0)
    in.fail("an element uses node " + std::to_string(node_tag) + ", which no $Nodes section before it holds",
            "the file is damaged: write it again");
  return point;
}

void State::index_nodes(const std::vector<GlobalIndex>& tags, std::size_t section) {
  nodes = TagIndex(tags);
  if (nodes.duplicate())
    in.fail_at(section, "two nodes have the tag " + std::to_string(*nodes.duplicate()),
               "the file is damaged: write it again");
}

}  // namespace alphadot::gmsh
