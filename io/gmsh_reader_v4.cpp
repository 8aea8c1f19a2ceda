// The sections of Gmsh's formats 4.0 and 4.1: elements come in blocks of one geometric entity, and entities
// tell their physical groups.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "io/gmsh_reader_state.hpp"

namespace alphadot::gmsh {
namespace {

/// Reads the physical tags of an entity and gives each to `take`.
template <class Take>
void read_physical_tags(Scanner& in, Take&& take) {
  const GlobalIndex count = in.read_long_count("the number of physical tags", {.ints = 1});
  for (GlobalIndex i = 0; i < count; ++i) take(in.read_int("a physical tag"));
}

void read_entity(State& state, int dimension, bool partitioned) {
  Scanner& in = state.in;
  const int tag = in.read_int("an entity tag");
  int parent_dimension = dimension;
  if (partitioned) {
    parent_dimension = in.read_int("the dimension of a parent");
    in.read_int("the tag of a parent");
    const GlobalIndex parts = in.read_long_count("the number of partitions of an entity", {.ints = 1});
    for (GlobalIndex i = 0; i < parts; ++i)
      if (const int part = in.read_int("a partition"); dimension == 3) state.parts.insert(part);
  }
  // A point has its place here from 4.1 on, others their bounding box, which is beyond all numbers when they
  // are empty.
  const int bounds = dimension == 0 && state.version == Version::v4_1 ? 3 : 6;
  for (int i = 0; i < bounds; ++i) in.skip_real("a bound of an entity");
  const bool is_interface = dimension == 2 && parent_dimension == 3;
  if (is_interface) append(state.interfaces, tag, in);
  read_physical_tags(in, [&](int physical) {
    if (dimension >= 2 && !is_interface) append(state.groups, {dimension, tag, physical}, in);
  });
  if (dimension == 0) return;
  const GlobalIndex bounding = in.read_long_count("the number of bounding entities", {.ints = 1});
  for (GlobalIndex i = 0; i < bounding; ++i) in.read_int("a bounding entity");
}

void read_entities(State& state, bool partitioned) {
  Scanner& in = state.in;
  std::array<GlobalIndex, 4> counts;
  for (GlobalIndex& count : counts)
    count = in.read_long_count("the number of entities", {.ints = 1, .longs = 1, .reals = 3});
  for (int dimension = 0; dimension < 4; ++dimension)
    for (GlobalIndex i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i)
      read_entity(state, dimension, partitioned);
  std::sort(state.groups.begin(), state.groups.end());
  std::sort(state.interfaces.begin(), state.interfaces.end());
}

/// A block of nodes or elements begins with its entity: dimension and tag, in 4.0 the other way round.
struct Entity {
  int dimension = 0, tag = 0;
};

Entity read_block_entity(State& state, const char* dimension, const char* tag) {
  Entity entity;
  if (state.version == Version::v4_0) entity.tag = state.in.read_int(tag);
  entity.dimension = state.in.read_int(dimension);
  if (state.version != Version::v4_0) entity.tag = state.in.read_int(tag);
  return entity;
}

/// Tags of nodes and elements have 64 bits from 4.1 on.
GlobalIndex read_tag(State& state, const char* meaning) {
  return state.version == Version::v4_0 ? state.in.read_int(meaning) : state.in.read_long(meaning);
}

RecordShape tags_of(const State& state, GlobalIndex count) {
  return state.version == Version::v4_0 ? RecordShape{.ints = count} : RecordShape{.longs = count};
}

/// The nodes of one block: first all tags, then all places; in 4.0 each tag before its place.
void read_node_block(State& state, std::vector<GlobalIndex>& tags) {
  Scanner& in = state.in;
  const bool alternating = state.version == Version::v4_0;
  const int dimension =
      read_block_entity(state, "the dimension of a block of nodes", "the entity of a block of nodes")
          .dimension;
  const bool parametric = in.read_int("whether the nodes are parametric") != 0;
  RecordShape shape = tags_of(state, 1);
  shape.reals = 3;
  const GlobalIndex count = in.read_long_count("the number of nodes in a block", shape);
  reserve_more(tags, count, in);
  reserve_more(state.mesh.points(), count, in);
  for (GlobalIndex i = 0; !alternating && i < count; ++i) append(tags, in.read_long("a node tag"), in);
  for (GlobalIndex i = 0; i < count; ++i) {
    if (alternating) append(tags, GlobalIndex{in.read_int("a node tag")}, in);
    append(state.mesh.points(), read_coordinates(in), in);
    for (int k = 0; parametric && k < std::min(dimension, 3); ++k) in.skip_real("a parametric coordinate");
  }
}

GlobalIndex read_element_block(State& state) {
  Scanner& in = state.in;
  const Entity entity =
      read_block_entity(state, "the dimension of a block of elements", "the entity of a block of elements");
  const ElementType type = state.element_type(in.read_int("an element type"));
  const GlobalIndex count =
      in.read_long_count("the number of elements in a block", tags_of(state, 1 + type.nodes));
  if (count == 0) return 0;
  const auto read = [&](auto& elements) {
    reserve_more(elements, count, in);
    for (GlobalIndex i = 0; i < count; ++i) {
      read_tag(state, "an element tag");
      auto& points = append(elements, {}, in);
      for (GlobalIndex& point : points) point = state.point_of(read_tag(state, "a node tag"));
      for (int k = type.corners(); k < type.nodes; ++k) read_tag(state, "a node tag");
    }
  };
  const bool is_interface =
      type.is_surface() && std::binary_search(state.interfaces.begin(), state.interfaces.end(), entity.tag);
  if (!type.shape || is_interface) {
    for (GlobalIndex i = 0; i < count * (1 + type.nodes); ++i) read_tag(state, "a tag");
  } else if (type.is_surface()) {
    MeshBuilder::with_faces(*type.shape, state.surface_of(state.group_of(2, entity.tag), entity.tag), read);
  } else {
    state.begin_volume(state.group_of(3, entity.tag), entity.tag);
    state.mesh.with_volumes(*type.shape, read);
  }
  if (type.curved && type.shape && !type.is_surface()) state.mesh.add_curved(count);
  return count;
}

/// What the header of $Nodes and of $Elements tells. Smallest and largest tag follow from 4.1 on; they are of
/// no use here.
struct BlockHeader {
  GlobalIndex blocks;
  GlobalIndex entries;
};

BlockHeader read_block_header(State& state) {
  Scanner& in = state.in;
  BlockHeader header;
  header.blocks = in.read_long_count("the number of blocks", {.ints = 3, .longs = 1});
  header.entries = in.read_long_count("the number of nodes or elements", tags_of(state, 2));
  if (state.version == Version::v4_0) return header;
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
  state.in.read_line();
  state.in.set_encoding(state.encoding);
  read_entities(state, false);
}

void read_partitioned_entities_v4(State& state) {
  Scanner& in = state.in;
  in.read_line();
  in.set_encoding(state.encoding);
  const GlobalIndex parts = in.read_long("the number of partitions");
  const GlobalIndex ghosts = in.read_long_count("the number of ghost entities", {.ints = 2});
  for (GlobalIndex i = 0; i < ghosts; ++i) {
    in.read_int("a ghost entity");
    in.read_int("the partition of a ghost entity");
  }
  read_entities(state, true);
  if (!state.parts.empty() && std::ssize(state.parts) < parts)
    in.fail(fmt::format("the file holds {} of {} partitions of a mesh", state.parts.size(), parts),
            "save the mesh in one file: set Mesh.PartitionSplitMeshFiles to 0, or merge the files in Gmsh");
}

void read_nodes_v4(State& state) {
  Scanner& in = state.in;
  const std::size_t section = in.position();
  in.read_line();
  in.set_encoding(state.encoding);
  const BlockHeader header = read_block_header(state);
  RecordShape shape = tags_of(state, 1);
  shape.reals = 3;
  in.check_count(header.entries, "the number of nodes", shape);

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
  const BlockHeader header = read_block_header(state);
  GlobalIndex found = 0;
  for (GlobalIndex block = 0; block < header.blocks; ++block) found += read_element_block(state);
  check_total(state, found, header.entries, "elements");
}

}  // namespace alphadot::gmsh
