// The sections of Gmsh's format 4.1: elements come in blocks of one geometric entity, and entities tell their
// physical groups.
#include <algorithm>
#include <climits>

#include "io/gmsh_reader_state.hpp"

namespace alphadot::gmsh {
namespace {

/// Reads the physical tags of an entity and gives each to `take`.
template <class Take>
void read_physical_tags(Scanner& in, Take&& take) {
  const GlobalIndex count = in.read_long_count("the number of physical tags", {.ints = 1});
  for (GlobalIndex i = 0; i < count; ++i) take(in.read_int("a physical tag"));
}

void read_entity(State& state, int dimension) {
  Scanner& in = state.in;
  const int tag = in.read_int("an entity tag");
  // A point has its place here, others their bounding box, which is beyond all numbers when they are empty.
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) in.skip_real("a bound of an entity");
  read_physical_tags(in, [&](int physical) {
    if (dimension == 2) append(state.surface_groups, {tag, physical}, in);
  });
  if (dimension == 0) return;
  const GlobalIndex bounding = in.read_long_count("the number of bounding entities", {.ints = 1});
  for (GlobalIndex i = 0; i < bounding; ++i) in.read_int("a bounding entity");
}

/// The nodes of one block: first all tags, then all places.
void read_node_block(State& state, std::vector<GlobalIndex>& tags) {
  Scanner& in = state.in;
  const int dimension = in.read_int("the dimension of a block of nodes");
  in.read_int("the entity of a block of nodes");
  const bool parametric = in.read_int("whether the nodes are parametric") != 0;
  const GlobalIndex count = in.read_long_count("the number of nodes in a block", {.longs = 1, .reals = 3});
  reserve_more(tags, count, in);
  reserve_more(state.mesh.points(), count, in);
  for (GlobalIndex i = 0; i < count; ++i) append(tags, in.read_long("a node tag"), in);
  for (GlobalIndex i = 0; i < count; ++i) {
    append(state.mesh.points(), read_coordinates(in), in);
    for (int k = 0; parametric && k < std::min(dimension, 3); ++k) in.skip_real("a parametric coordinate");
  }
}

/// The patch of a surface: the one of its physical groups that has a name.
Patch& patch_of(State& state, int surface) {
  std::string_view name;
  auto group =
      std::lower_bound(state.surface_groups.begin(), state.surface_groups.end(), std::pair{surface, INT_MIN});
  for (; group != state.surface_groups.end() && group->first == surface; ++group) {
    const std::string_view other = state.surface_name(group->second);
    if (!name.empty() && !other.empty() && other != name)
      state.in.fail("surface " + std::to_string(surface) + " belongs to two named physical groups, " +
                        quoted(name) + " and " + quoted(other),
                    "leave it in one of them");
    if (name.empty()) name = other;
  }
  if (name.empty())
    state.in.fail(
        "boundary triangles of surface " + std::to_string(surface) + " belong to no named physical group",
        state.partitioned ? "save the mesh without partitions"
                          : "add Physical Surface(\"name\") = {" + std::to_string(surface) + "};");
  return state.mesh.patch(name, state.in);
}

template <std::size_t n>
void read_element_block(State& state, GlobalIndex count, std::vector<std::array<GlobalIndex, n>>& elements) {
  reserve_more(elements, count, state.in);
  for (GlobalIndex i = 0; i < count; ++i) {
    state.in.read_long("an element tag");
    std::array<GlobalIndex, n>& points = append(elements, {}, state.in);
    for (GlobalIndex& point : points) point = state.point_of(state.in.read_long("a node tag"));
  }
}

GlobalIndex read_element_block(State& state) {
  Scanner& in = state.in;
  in.read_int("the dimension of a block of elements");
  const int entity = in.read_int("the entity of a block of elements");
  const ElementType& type = state.element_type(in.read_int("an element type"));
  const GlobalIndex count =
      in.read_long_count("the number of elements in a block", {.longs = 1 + type.nodes});
  if (count == 0) return 0;
  switch (type.use) {
    case ElementUse::tetrahedron:
      read_element_block(state, count, state.mesh.cells());
      break;
    case ElementUse::triangle:
      read_element_block(state, count, patch_of(state, entity).triangles);
      break;
    case ElementUse::refused:
      state.mesh.refuse(type.plural, count);
      [[fallthrough]];
    case ElementUse::ignored:
      for (GlobalIndex i = 0; i < count * (1 + type.nodes); ++i) in.read_long("a tag");
  }
  return count;
}

/// What the header of $Nodes and of $Elements tells. Smallest and largest tag follow; they are of no use
/// here.
struct BlockHeader {
  GlobalIndex blocks;
  GlobalIndex entries;
};

BlockHeader read_block_header(Scanner& in) {
  BlockHeader header;
  header.blocks = in.read_long_count("the number of blocks", {.ints = 3, .longs = 1});
  header.entries = in.read_long_count("the number of nodes or elements", {.longs = 2});
  in.read_long("the smallest tag");
  in.read_long("the largest tag");
  return header;
}

void check_total(const State& state, GlobalIndex found, GlobalIndex announced, const std::string& plural) {
  if (found != announced)
    state.in.fail("the blocks hold " + std::to_string(found) + " " + plural + ", but the section announces " +
                      std::to_string(announced),
                  "the file is damaged: write it again");
}

}  // namespace

void read_entities_v4(State& state) {
  Scanner& in = state.in;
  in.read_line();
  in.set_encoding(state.encoding);
  std::array<GlobalIndex, 4> counts;
  for (GlobalIndex& count : counts)
    count = in.read_long_count("the number of entities", {.ints = 1, .longs = 1, .reals = 3});
  for (int dimension = 0; dimension < 4; ++dimension)
    for (GlobalIndex i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i)
      read_entity(state, dimension);
  std::sort(state.surface_groups.begin(), state.surface_groups.end());
}

void read_nodes_v4(State& state) {
  Scanner& in = state.in;
  const std::size_t section = in.position();
  in.read_line();
  in.set_encoding(state.encoding);
  const BlockHeader header = read_block_header(in);
  in.check_count(header.entries, "the number of nodes", {.longs = 1, .reals = 3});

  std::vector<GlobalIndex> tags;
  reserve_more(tags, header.entries, in);
  reserve_more(state.mesh.points(), header.entries, in);
  for (GlobalIndex block = 0; block < header.blocks; ++block) read_node_block(state, tags);
  check_total(state, static_cast<GlobalIndex>(tags.size()), header.entries, "nodes");
  state.index_nodes(tags, section);
}

void read_elements_v4(State& state) {
  Scanner& in = state.in;
  in.read_line();
  in.set_encoding(state.encoding);
  const BlockHeader header = read_block_header(in);
  GlobalIndex found = 0;
  for (GlobalIndex block = 0; block < header.blocks; ++block) found += read_element_block(state);
  check_total(state, found, header.entries, "elements");
  state.mesh.check_refused(in);
}

}  // namespace alphadot::gmsh
