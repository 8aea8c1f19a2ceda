// What the sections of a Gmsh file share while it is read.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/mesh_builder.hpp"
#include "io/scanner.hpp"
#include "io/tag_index.hpp"

namespace alphadot::gmsh {

enum class ElementUse { ignored, triangle, tetrahedron, refused };

/// One of Gmsh's element types.
struct ElementType {
  int nodes;
  ElementUse use;
  const char* plural;
};

/// The state of one reading: each section reader takes its part from the scanner and leaves what later ones
/// need.
struct State {
  State(std::string_view content, const std::string& file) : in(content, file), mesh(file) {}

  Scanner in;
  MeshBuilder mesh;
  Encoding encoding = Encoding::text;                                   ///< of the sections of numbers
  TagIndex nodes;                                                       ///< node tag to point
  std::vector<std::pair<GlobalIndex, std::string_view>> surface_names;  ///< (physical tag, name), sorted
  std::vector<std::pair<int, int>> surface_groups;  ///< (surface, physical tag), sorted; 4.1 only
  bool partitioned = false;  ///< the file has been cut by Gmsh, so that surfaces have new tags

  /// The element type of Gmsh's number. Throws InputError for one that is not known.
  const ElementType& element_type(int number) const;
  /// The name of a physical surface; empty when it has none. The sign of the tag, which tells how the surface
  /// is oriented within its group, does not count.
  std::string_view surface_name(GlobalIndex physical_tag) const;
  /// The point of a node that an element uses. Throws InputError when the file does not have it.
  GlobalIndex point_of(GlobalIndex node_tag) const;
  /// Makes `nodes` from the tags of the points read so far. Throws InputError, at the start of the section,
  /// for a tag used twice.
  void index_nodes(const std::vector<GlobalIndex>& tags, std::size_t section);
};

void read_nodes_v2(State& state);
void read_elements_v2(State& state);

void read_entities_v4(State& state);
void read_nodes_v4(State& state);
void read_elements_v4(State& state);

}  // namespace alphadot::gmsh
