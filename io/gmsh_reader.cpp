#include "io/gmsh_reader.hpp"

#include <algorithm>
#include <utility>

#include "io/gmsh_reader_state.hpp"

namespace alphadot {
namespace gmsh {
namespace {

enum class Version { v2_2, v4_1 };

Version read_format(State& state) {
  Scanner& in = state.in;
  in.expect("$MeshFormat");
  const std::string_view number = in.read_word();
  if (number != "2.2" && number != "4.1")
    in.fail("Gmsh format " + quoted(number) + " is not known, only 2.2 and 4.1",
            "save it with \"gmsh -format msh41\"");
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
  return number == "2.2" ? Version::v2_2 : Version::v4_1;
}

/// A name in double quotes, which may hold blanks.
std::string_view read_name(Scanner& in) {
  const std::string_view line = in.read_line();
  const std::size_t first = line.find('"');
  const std::size_t last = line.rfind('"');
  if (first == last) in.fail("a name in double quotes should stand here", "write the file again");
  return line.substr(first + 1, last - first - 1);
}

void read_physical_names(State& state) {
  Scanner& in = state.in;
  const GlobalIndex count = in.read_int_count("the number of physical names", {.ints = 3});
  reserve_more(state.surface_names, count, in);
  for (GlobalIndex i = 0; i < count; ++i) {
    const int dimension = in.read_int("the dimension of a physical group");
    const int tag = in.read_int("the tag of a physical group");
    const std::string_view name = read_name(in);
    if (dimension == 2) append(state.surface_names, {tag, name}, in);
  }
  std::sort(state.surface_names.begin(), state.surface_names.end());
}

/// Reads one section, whose numbers are in the file's encoding, and its end.
void read_section(State& state, Version version, std::string_view name) {
  Scanner& in = state.in;
  const bool v2 = version == Version::v2_2;
  if (name == "$PhysicalNames") {
    read_physical_names(state);
  } else if (name == "$Nodes") {
    if (!state.mesh.points().empty()) in.fail("a second $Nodes section", "save the mesh as one model");
    v2 ? read_nodes_v2(state) : read_nodes_v4(state);
  } else if (name == "$Elements") {
    v2 ? read_elements_v2(state) : read_elements_v4(state);
  } else if (name == "$Entities" && !v2) {
    read_entities_v4(state);
  } else {
    if (name == "$PartitionedEntities") state.partitioned = true;
    const std::size_t start = in.position();
    const std::string end = "$End" + std::string(name.substr(1));
    if (!in.skip_past(end))
      in.fail_at(start - 1, "the section " + quoted(name) + " has no end", "write the file again");
    return;
  }
  in.set_encoding(Encoding::text);
  in.expect("$End" + std::string(name.substr(1)));
}

}  // namespace
}  // namespace gmsh

Mesh read_gmsh(std::string_view content, const std::string& file) {
  gmsh::State state(content, file);
  const gmsh::Version version = gmsh::read_format(state);
  while (!state.in.at_end()) {
    const std::string_view name = state.in.read_word();
    if (!name.starts_with('$') || name.starts_with("$End") || name.size() == 1)
      state.in.fail("a section such as $Nodes should start here, not " + quoted(name),
                    "the file is damaged: write it again");
    gmsh::read_section(state, version, name);
  }
  return std::move(state.mesh)
      .finish(
          "Gmsh saves the elements of physical groups only: add Physical Volume(\"fluid\") = {...}; and mesh "
          "in 3D");
}

}  // namespace alphadot
