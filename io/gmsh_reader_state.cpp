#include "io/gmsh_reader_state.hpp"

#include <algorithm>
#include <climits>
#include <cstdlib>

namespace alphadot::gmsh {
namespace {

/// The numbers of one shape's types, each with its number of nodes; the first is the one without curvature.
struct Family {
  std::optional<Shape> shape;
  std::array<std::pair<int, int>, 8> types;  ///< (Gmsh's number, nodes)
};

// From the table of $Elements in the reference manual, "MSH file format", and of higher order.
constexpr std::array<Family, 8> families{
    {{std::nullopt, {{{1, 2}, {8, 3}, {26, 4}, {27, 5}, {28, 6}}}},
     {std::nullopt, {{{15, 1}}}},
     {Shape::triangle, {{{2, 3}, {9, 6}, {20, 9}, {21, 10}, {22, 12}, {23, 15}, {24, 15}, {25, 21}}}},
     {Shape::quadrilateral, {{{3, 4}, {10, 9}, {16, 8}, {36, 16}, {37, 25}, {38, 36}}}},
     {Shape::tetrahedron, {{{4, 4}, {11, 10}, {29, 20}, {30, 35}, {31, 56}}}},
     {Shape::hexahedron, {{{5, 8}, {12, 27}, {17, 20}, {92, 64}, {93, 125}}}},
     {Shape::prism, {{{6, 6}, {13, 18}, {18, 15}, {90, 40}, {91, 75}}}},
     {Shape::pyramid, {{{7, 5}, {14, 14}, {19, 13}, {118, 30}, {119, 55}}}}}};

/// By Gmsh's number: most files have a number for every element. No nodes where there is no such type.
constexpr auto element_types = [] {
  std::array<ElementType, 120> out{};
  for (const Family& family : families)
    for (const auto& [type, size] : family.types)
      if (size > 0) out[static_cast<std::size_t>(type)] = {size, family.shape, type != family.types[0].first};
  return out;
}();

}  // namespace

ElementType State::element_type(int number) const {
  if (number > 0 && number < std::ssize(element_types))
    if (const ElementType& type = element_types[static_cast<std::size_t>(number)]; type.nodes > 0)
      return type;
  in.fail("elements of Gmsh's type " + std::to_string(number) + " are not known",
          "mesh with tetrahedra, hexahedra, prisms and pyramids");
}

std::string_view State::group_name(int dimension, GlobalIndex tag) const {
  tag = std::abs(tag);
  const auto found = std::lower_bound(names.begin(), names.end(), GroupName{dimension, tag, {}});
  const bool known = found != names.end() && found->dimension == dimension && found->tag == tag;
  return known ? found->name : std::string_view{};
}

Surface& State::surface_of(int group, int surface) {
  const std::string_view name = group_name(2, group);
  if (!name.empty()) return mesh.surface(name, in);
  const std::string made = group != 0 ? "group_" + std::to_string(std::abs(GlobalIndex{group}))
                                      : "surface_" + std::to_string(surface);
  Surface& patch = mesh.surface(made, in);
  made_names.insert(made);
  return patch;
}

void State::begin_volume(int group, int volume) {
  const std::string_view name = group_name(3, group);
  if (!name.empty())
    mesh.begin_volume(name);
  else
    mesh.begin_volume(group != 0 ? "group_" + std::to_string(std::abs(GlobalIndex{group}))
                                 : "volume_" + std::to_string(volume));
}

int State::group_of(int dimension, int entity) const {
  std::string_view name;
  int named = 0, unnamed = 0;
  for (auto found = std::lower_bound(groups.begin(), groups.end(), Membership{dimension, entity, INT_MIN});
       found != groups.end() && found->dimension == dimension && found->entity == entity; ++found) {
    const std::string_view other = group_name(dimension, found->group);
    if (dimension == 2 && !name.empty() && !other.empty() && other != name)
      in.fail("surface " + std::to_string(entity) + " belongs to two named physical groups, " + quoted(name) +
                  " and " + quoted(other),
              "leave it in one of them");
    if (other.empty() && unnamed == 0) unnamed = found->group;
    if (!other.empty()) {
      name = other;
      named = found->group;
    }
  }
  return named != 0 ? named : unnamed;
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
