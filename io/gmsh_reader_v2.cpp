// The sections of Gmsh's format 2.2: every element tells its physical group itself.
#include <algorithm>

#include "io/gmsh_reader_state.hpp"

namespace alphadot::gmsh {
namespace {

/// What stands before the nodes of an element: its groups, then tags that are of no use here.
struct Tags {
  int physical = 0;
  int surface = 0;
};

Tags read_tags(Scanner& in, GlobalIndex count) {
  Tags tags;
  for (GlobalIndex i = 0; i < count; ++i) {
    const int tag = in.read_int("an element's tag");
    if (i == 0) tags.physical = tag;
    if (i == 1) tags.surface = tag;
  }
  return tags;
}

template <std::size_t n>
std::array<GlobalIndex, n> read_points(State& state) {
  std::array<GlobalIndex, n> points;
  for (GlobalIndex& point : points) point = state.point_of(state.in.read_int("a node tag"));
  return points;
}

Patch& patch_of(State& state, const Tags& tags) {
  const std::string_view name = state.surface_name(tags.physical);
  if (name.empty())
    state.in.fail("boundary triangles of surface " + std::to_string(tags.surface) + " (physical tag " +
                      std::to_string(tags.physical) + ") belong to no named physical group",
                  "add Physical Surface(\"name\") = {" + std::to_string(tags.surface) + "};");
  return state.mesh.patch(name, state.in);
}

void read_element(State& state, const ElementType& type, GlobalIndex tag_count) {
  const Tags tags = read_tags(state.in, tag_count);
  switch (type.use) {
    case ElementUse::tetrahedron:
      append(state.mesh.cells(), read_points<4>(state), state.in);
      return;
    case ElementUse::triangle: {
      Patch& patch = patch_of(state, tags);
      append(patch.triangles, read_points<3>(state), state.in);
      return;
    }
    case ElementUse::refused:
      state.mesh.refuse(type.plural, 1);
      [[fallthrough]];
    case ElementUse::ignored:
      for (int i = 0; i < type.nodes; ++i) state.in.read_int("a node tag");
  }
}

/// Binary elements come in runs of one type.
void read_binary_elements(State& state, GlobalIndex count) {
  Scanner& in = state.in;
  for (GlobalIndex i = 0; i < count;) {
    const ElementType& type = state.element_type(in.read_int("an element type"));
    const GlobalIndex run = in.read_int_count("the number of elements in a run", {.ints = 2});
    const GlobalIndex tag_count = in.read_int_count("the number of tags", {.ints = 1});
    if (run > count - i)
      in.fail("a run of elements goes beyond their number", "the file is damaged: write it again");
    for (GlobalIndex k = 0; k < run; ++k) {
      in.read_int("an element tag");
      read_element(state, type, tag_count);
    }
    i += run;
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

  if (state.encoding == Encoding::text) {
    for (GlobalIndex i = 0; i < count; ++i) {
      in.read_int("an element tag");
      const ElementType& type = state.element_type(in.read_int("an element type"));
      read_element(state, type, in.read_int_count("the number of tags", {.ints = 1}));
    }
  } else {
    read_binary_elements(state, count);
  }
  state.mesh.check_refused(in);
}

}  // namespace alphadot::gmsh
