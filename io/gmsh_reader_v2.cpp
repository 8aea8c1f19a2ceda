// The sections of Gmsh's formats 1 to 2.2: every element tells its physical group itself.
#include <algorithm>

#include "io/gmsh_reader_state.hpp"

namespace alphadot::gmsh {
namespace {

/// What stands before the nodes of an element: its group and entity, then tags that are of no use here.
struct Tags {
  int group = 0;
  int entity = 0;
  bool operator==(const Tags&) const = default;
};

Tags read_tags(Scanner& in, GlobalIndex count) {
  Tags tags;
  for (GlobalIndex i = 0; i < count; ++i) {
    const int tag = in.read_int("an element's tag");
    if (i == 0) tags.group = tag;
    if (i == 1) tags.entity = tag;
  }
  return tags;
}

/// Reads elements one after the other; most are of the volume of the one before.
class ElementReader {
 public:
  explicit ElementReader(State& state) : state_(state) {}

  void read(const ElementType& type, const Tags& tags) {
    const auto add = [&](auto& elements) {
      auto& points = append(elements, {}, state_.in);
      for (GlobalIndex& point : points) point = state_.point_of(state_.in.read_int("a node tag"));
    };
    if (type.is_surface()) {
      MeshBuilder::with_faces(*type.shape, state_.surface_of(tags.group, tags.entity), add);
    } else if (type.shape) {
      if (volume_ != tags) state_.begin_volume(tags.group, tags.entity);
      volume_ = tags;
      state_.mesh.with_volumes(*type.shape, add);
      if (type.curved) state_.mesh.add_curved(1);
    }
    for (int i = type.corners(); i < type.nodes; ++i) state_.in.read_int("a node tag");
  }

 private:
  State& state_;
  std::optional<Tags> volume_;
};

/// Binary elements come in runs of one type.
void read_binary_elements(State& state, GlobalIndex count) {
  Scanner& in = state.in;
  ElementReader elements(state);
  for (GlobalIndex i = 0; i < count;) {
    const ElementType type = state.element_type(in.read_int("an element type"));
    const GlobalIndex run = in.read_int_count("the number of elements in a run", {.ints = 2});
    const GlobalIndex tag_count = in.read_int_count("the number of tags", {.ints = 1});
    if (run > count - i)
      in.fail("a run of elements goes beyond their number", "the file is damaged: write it again");
    for (GlobalIndex k = 0; k < run; ++k) {
      in.read_int("an element tag");
      elements.read(type, read_tags(in, tag_count));
    }
    i += run;
  }
}

/// Format 1 has always two tags, and tells the number of nodes.
void read_elements_v1(State& state, GlobalIndex count) {
  Scanner& in = state.in;
  ElementReader elements(state);
  for (GlobalIndex i = 0; i < count; ++i) {
    in.read_int("an element tag");
    const ElementType type = state.element_type(in.read_int("an element type"));
    const Tags tags = read_tags(in, 2);
    const int nodes = in.read_int("the number of nodes of an element");
    if (nodes != type.nodes)
      in.fail("an element has " + std::to_string(nodes) + " nodes, where its type has " +
                  std::to_string(type.nodes),
              "the file is damaged: write it again");
    elements.read(type, tags);
  }
}

}  // namespace

void read_nodes_v2(State& state) {
  Scanner& in = state.in;
  const std::size_t section = in.position();
  const GlobalIndex count = in.read_long("the number of nodes");
  in.read_line();
  in.set_encoding(state.encoding);
  in.check_count(count, "the number of nodes", {.ints = 1, .reals = 3});

  std::vector<GlobalIndex> tags;
  reserve_more(tags, count, in);
  reserve_more(state.mesh.points(), count, in);
  for (GlobalIndex i = 0; i < count; ++i) {
    append(tags, GlobalIndex{in.read_int("a node tag")}, in);
    append(state.mesh.points(), read_coordinates(in), in);
  }
  state.index_nodes(tags, section);
}

void read_elements_v2(State& state) {
  Scanner& in = state.in;
  const GlobalIndex count = in.read_long("the number of elements");
  in.read_line();
  in.set_encoding(state.encoding);
  in.check_count(count, "the number of elements", {.ints = 2});
  // Most elements are tetrahedra, of seven numbers each at least when they tell their groups.
  reserve_more(state.mesh.cells(), std::min(count, in.capacity({.ints = 7})), in);

  if (state.version == Version::v1) {
    read_elements_v1(state, count);
  } else if (state.encoding == Encoding::text) {
    ElementReader elements(state);
    for (GlobalIndex i = 0; i < count; ++i) {
      in.read_int("an element tag");
      const ElementType type = state.element_type(in.read_int("an element type"));
      elements.read(type, read_tags(in, in.read_int_count("the number of tags", {.ints = 1})));
    }
  } else {
    read_binary_elements(state, count);
  }
}

}  // namespace alphadot::gmsh
