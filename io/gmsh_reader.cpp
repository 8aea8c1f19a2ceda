#include "io/gmsh_reader.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "io/gmsh_reader_state.hpp"

namespace alphadot {
namespace gmsh {
namespace {

Version version_of(const Scanner& in, std::string_view number) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error == std::errc{} && end == number.data() + number.size()) {
    if (value == 1) return Version::v1;
    if (value >= 2 && value <= 2.2) return Version::v2;
    if (value == 4) return Version::v4_0;
    if (value == 4.1) return Version::v4_1;
  }
  in.fail("Gmsh format " + quoted(number) + " is not known, only 1, 2 to 2.2, 4 and 4.1",
          "save it with \"gmsh FILE -save -format msh41 -o mesh.msh\"");
}

void read_format(State& state) {
  Scanner& in = state.in;
  state.version = version_of(in, in.read_word());
  const bool binary = in.read_int("the file type") != 0;
  const int size_bytes = in.read_int("the data size");
  if (size_bytes != 8)
    in.fail("the data size is " + std::to_string(size_bytes) + " bytes, only 8 is known",
            "save it with another Gmsh");
  in.read_line();
  if (binary) {
    // A binary file holds the integer 1 here, to tell the order of its bytes.
    in.set_encoding(native_encoding);
    const std::int32_t one = in.read_int("the integer 1");
    state.encoding = one == 1 ? native_encoding : swapped_encoding;
    if (one != 1 && one != 0x01000000)
      in.fail("the integer 1 should stand here", "the file is damaged: write it again");
    in.set_encoding(Encoding::text);
  }
  in.expect("$EndMeshFormat");
}

/// The name of a physical group and its numbers: dimension and tag, or in files of format 2.0 the tag alone.
void read_physical_name(State& state) {
  Scanner& in = state.in;
  const int first = in.read_int("the dimension or tag of a physical group");
  int dimension = 2, tag = first;
  const std::string_view rest = in.peek_line();
  const std::size_t blanks = std::min(rest.find_first_not_of(" \t"), rest.size());
  if (!rest.substr(blanks).starts_with('"')) {
    dimension = first;
    tag = in.read_int("the tag of a physical group");
  }
  const std::string_view line = in.read_line();
  const std::size_t begin = line.find('"');
  const std::size_t end = line.rfind('"');
  if (begin == end) in.fail("a name in double quotes should stand here", "write the file again");
  if (dimension >= 2) append(state.names, {dimension, tag, line.substr(begin + 1, end - begin - 1)}, in);
}

void read_physical_names(State& state) {
  Scanner& in = state.in;
  const GlobalIndex count = in.read_int_count("the number of physical names", {.ints = 2});
  reserve_more(state.names, count, in);
  for (GlobalIndex i = 0; i < count; ++i) read_physical_name(state);
  std::sort(state.names.begin(), state.names.end());
}

/// Passes over a section that is of no use here, with its end.
void pass_over(State& state, std::string_view name) {
  const std::size_t start = state.in.position();
  const std::string end = "$End" + std::string(name.substr(1));
  if (!state.in.skip_past(end))
    state.in.fail_at(start - 1, "the section " + quoted(name) + " has no end", "write the file again");
}

/// Reads one section, whose numbers are in the file's encoding, and its end.
void read_section(State& state, std::string_view name) {
  Scanner& in = state.in;
  const bool v1 = state.version == Version::v1;
  const bool v4 = state.version == Version::v4_0 || state.version == Version::v4_1;
  if (name == "$PhysicalNames") {
    read_physical_names(state);
  } else if (name == (v1 ? "$NOD" : "$Nodes")) {
    if (!state.mesh.points().empty()) in.fail("a second $Nodes section", "save the mesh as one model");
    v4 ? read_nodes_v4(state) : read_nodes_v2(state);
  } else if (name == (v1 ? "$ELM" : "$Elements")) {
    v4 ? read_elements_v4(state) : read_elements_v2(state);
  } else if (name == "$Entities" && v4) {
    read_entities_v4(state);
  } else if (name == "$PartitionedEntities" && v4) {
    read_partitioned_entities_v4(state);
  } else {
    return pass_over(state, name);
  }
  in.set_encoding(Encoding::text);
  in.expect((v1 ? "$END" : "$End") + std::string(name.substr(1)));
}

std::string_view read_section_name(State& state) {
  const std::string_view name = state.in.read_word();
  if (!name.starts_with('$') || name.starts_with("$End") || name.size() == 1)
    state.in.fail("a section such as $Nodes should start here, not " + quoted(name),
                  "the file is damaged: write it again");
  return name;
}

/// Reads up to the format: other sections may stand before it, and files of format 1 have none.
void read_beginning(State& state) {
  state.in.skip_byte_order_mark();
  for (;;) {
    const std::string_view name = read_section_name(state);
    if (name == "$MeshFormat") return read_format(state);
    if (name == "$NOD") {
      state.version = Version::v1;
      return read_section(state, name);
    }
    pass_over(state, name);
  }
}

void note_made_names(State& state) {
  if (state.made_names.empty()) return;
  constexpr std::size_t most = 12;
  std::string list;
  std::size_t listed = 0;
  for (const std::string& name : state.made_names) {
    if (listed == most) break;
    list += (listed++ == 0 ? "" : ", ") + name;
  }
  if (state.made_names.size() > most)
    list += " and " + std::to_string(state.made_names.size() - most) + " more";
  state.mesh.note(
      "patches named by the tags of their physical groups of dimension 2, which have no names, or "
      "of their surfaces, which are in no group: " +
      list);
}

}  // namespace
}  // namespace gmsh

MeshOfFile read_gmsh(std::string_view content, const std::string& file) {
  gmsh::State state(content, file);
  gmsh::read_beginning(state);
  while (!state.in.at_end()) gmsh::read_section(state, gmsh::read_section_name(state));
  gmsh::note_made_names(state);
  return std::move(state.mesh)
      .finish(
          "Gmsh saves the elements of physical groups only: add Physical Volume(\"fluid\") = {...}; and "
          "mesh in 3D");
}

}  // namespace alphadot
