// What the sections of a Gmsh file share while it is read.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/mesh_builder.hpp"
#include "io/scanner.hpp"
#include "io/tag_index.hpp"

namespace alphadot::gmsh {

/// The formats: 1 has sections of its own, those from 2 to 2.2 differ in what is passed over here.
enum class Version { v1, v2, v4_0, v4_1 };

/// One of Gmsh's element types. Its corners come first among its nodes.
struct ElementType {
  int nodes = 0;
  std::optional<Shape> shape;  ///< none for points and lines, which are passed over
  bool curved = false;         ///< of second order or higher

  int corners() const { return shape ? static_cast<int>(corner_count(*shape)) : 0; }
  bool is_surface() const { return shape == Shape::triangle || shape == Shape::quadrilateral; }
};

/// The name of a physical group of surfaces (dimension 2) or volumes (3).
struct GroupName {
  int dimension;
  GlobalIndex tag;
  std::string_view name;
  auto operator<=>(const GroupName&) const = default;
};

/// That a surface or volume is in a physical group.
struct Membership {
  int dimension, entity, group;
  auto operator<=>(const Membership&) const = default;
};

/// The state of one reading: each section reader takes its part from the scanner and leaves what later ones
/// need.
struct State {
  State(std::string_view content, const std::string& file) : in(content, file), mesh(file) {}

  Scanner in;
  MeshBuilder mesh;
  Version version = Version::v4_1;
  Encoding encoding = Encoding::text;  ///< of the sections of numbers
  TagIndex nodes;                      ///< node tag to point
  std::vector<GroupName> names;        ///< of physical groups, sorted
  std::vector<Membership> groups;      ///< physical groups of surfaces and volumes, sorted; from 4.0 on
  std::set<int> parts;                 ///< partitions that the file has volumes of
  std::vector<int> interfaces;         ///< surfaces between the partitions of a file, sorted: no boundaries
  std::set<std::string, std::less<>>
      made_names;  ///< patch names made here of the tags of groups and surfaces

  /// The element type of Gmsh's number. Throws InputError for one that is not known.
  ElementType element_type(int number) const;
  /// The name of a physical group; empty when it has none. The sign of the tag, which tells how the surface
  /// is oriented within its group, does not count.
  std::string_view group_name(int dimension, GlobalIndex tag) const;
  /// The patch of a surface in a physical group, or in none when `group` is 0: under the group's name or one
  /// made of a tag.
  Surface& surface_of(int group, int surface);
  /// Volume elements that follow belong to that volume of that physical group, 0 for none.
  void begin_volume(int group, int volume);
  /// The one of an entity's physical groups that has a name, else the first of them, else 0. Throws
  /// InputError when a surface has several names.
  int group_of(int dimension, int entity) const;
  /// The point of a node that an element uses. Throws InputError when the file does not have it.
  GlobalIndex point_of(GlobalIndex node_tag) const;
  /// Makes `nodes` from the tags of the points read so far. Throws InputError, at the start of the section,
  /// for a tag used twice.
  void index_nodes(const std::vector<GlobalIndex>& tags, std::size_t section);
};

/// One section each, from the line after its name to its end. All throw InputError with the place in the
/// file.
void read_nodes_v2(State& state);
void read_elements_v2(State& state);

void read_entities_v4(State& state);
void read_partitioned_entities_v4(State& state);
void read_nodes_v4(State& state);
void read_elements_v4(State& state);

}  // namespace alphadot::gmsh
