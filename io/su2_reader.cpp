#include "io/su2_reader.hpp"

#include <array>
#include <optional>
#include <utility>

#include "io/mesh_builder.hpp"
#include "io/scanner.hpp"

namespace alphadot {
namespace {

constexpr const char* rewrite = "the file is damaged: write it again";

/// One of the element types of SU2, which are those of VTK.
struct ElementType {
  int number;
  int nodes;
  const char* plural;
};
constexpr int triangle = 5;
constexpr int tetrahedron = 10;
constexpr std::array<ElementType, 7> element_types{{{3, 2, "lines"},
                                                    {triangle, 3, "triangles"},
                                                    {9, 4, "quadrilaterals"},
                                                    {tetrahedron, 4, "tetrahedra"},
                                                    {12, 8, "hexahedra"},
                                                    {13, 6, "prisms"},
                                                    {14, 5, "pyramids"}}};

class Su2Reader {
 public:
  Su2Reader(std::string_view content, const std::string& file)
      : in_(content, file, '%'), mesh_(file), point_count_(find_point_count(in_)) {}

  Mesh read();

 private:
  static GlobalIndex find_point_count(Scanner in);
  void read_section();
  void read_points();
  void read_cells();
  void read_marker_tag();
  void read_marker_elements();
  template <std::size_t n>
  void read_elements(int wanted, GlobalIndex count, std::vector<std::array<GlobalIndex, n>>& elements);
  const ElementType& read_element_type();
  GlobalIndex read_point_id();
  std::optional<GlobalIndex> read_index();
  void end_record();
  void pass_over_data();

  Scanner in_;
  MeshBuilder mesh_;
  GlobalIndex point_count_;  ///< as announced; checked when the points are read
  bool is_3d_ = false;
  std::optional<GlobalIndex> marker_count_;  ///< as announced
  GlobalIndex markers_found_ = 0;
  std::string_view marker_;  ///< a MARKER_TAG that waits for its MARKER_ELEMS
};

/// Elements usually come before the points; so that their point ids can be checked where they stand, the
/// number of points is looked up first.
GlobalIndex Su2Reader::find_point_count(Scanner in) {
  for (; !in.at_end(); in.read_line())
    if (in.read_word('=') == "NPOIN" && in.accept('=')) return in.read_long("the number of points");
  in.fail("there is no NPOIN section", "write the points, or check that this is an SU2 mesh");
}

Mesh Su2Reader::read() {
  while (!in_.at_end()) read_section();
  if (!marker_.empty()) in_.fail("marker " + quoted(marker_) + " has no MARKER_ELEMS", rewrite);
  if (static_cast<GlobalIndex>(mesh_.points().size()) != point_count_)
    in_.fail("a second NPOIN section", rewrite);
  if (!is_3d_) in_.fail("there is no NDIME= 3", "give the dimension of the mesh");
  if (!marker_count_) in_.fail("there is no NMARK section", "write the boundary as markers");
  if (*marker_count_ != markers_found_)
    in_.fail("NMARK announces " + std::to_string(*marker_count_) + " markers, but there are " +
                 std::to_string(markers_found_),
             rewrite);
  return std::move(mesh_).finish("write the volume elements into its NELEM section");
}

void Su2Reader::read_section() {
  const std::string_view keyword = in_.read_word('=');
  if (keyword.empty() || !in_.accept('='))
    in_.fail("a keyword such as NELEM= should stand here, not " + quoted(keyword),
             "check that the section before it is as long as announced");
  if (keyword == "NDIME") {
    if (in_.read_int("the dimension") != 3)
      in_.fail("the mesh is not three-dimensional", "only NDIME= 3 can be used");
    is_3d_ = true;
  } else if (keyword == "NZONE") {
    if (in_.read_int("the number of zones") != 1)
      in_.fail("the file holds several zones", "write one zone a file");
  } else if (keyword == "NPOIN") {
    read_points();
  } else if (keyword == "NELEM") {
    read_cells();
  } else if (keyword == "NMARK") {
    marker_count_ = in_.read_long("the number of markers");
  } else if (keyword == "MARKER_TAG") {
    read_marker_tag();
  } else if (keyword == "MARKER_ELEMS") {
    read_marker_elements();
  } else {
    pass_over_data();
  }
}

void Su2Reader::read_points() {
  if (!mesh_.points().empty()) in_.fail("a second NPOIN section", rewrite);
  const GlobalIndex count = in_.read_long_count("the number of points", {.reals = 3});
  // Files from partitioned runs tell here how many points are not halo points.
  read_index();
  end_record();
  reserve_more(mesh_.points(), count, in_);
  for (GlobalIndex i = 0; i < count; ++i) {
    append(mesh_.points(), read_coordinates(in_), in_);
    const std::optional<GlobalIndex> index = read_index();
    if (index && *index != i)
      in_.fail("point " + std::to_string(i) + " has the index " + std::to_string(*index),
               "SU2 numbers points by their order, from 0: write them in order");
    end_record();
  }
}

void Su2Reader::read_cells() {
  const GlobalIndex count = in_.read_long_count("the number of elements", {.ints = 1, .longs = 2});
  read_elements(tetrahedron, count, mesh_.cells());
  mesh_.check_refused(in_);
}

void Su2Reader::read_marker_tag() {
  if (!marker_.empty()) in_.fail("marker " + quoted(marker_) + " has no MARKER_ELEMS", rewrite);
  if (in_.at_end_of_line()) in_.fail("a marker has no name", "write MARKER_TAG= name");
  marker_ = in_.read_word();
  if (mesh_.has_patch(marker_))
    in_.fail("a second marker " + quoted(marker_), "give every marker a name of its own");
}

void Su2Reader::read_marker_elements() {
  if (marker_.empty()) in_.fail("MARKER_ELEMS without a MARKER_TAG before it", rewrite);
  const GlobalIndex count = in_.read_long_count("the number of marker elements", {.ints = 1, .longs = 2});
  read_elements(triangle, count, mesh_.patch(marker_, in_).triangles);
  mesh_.check_refused(in_);
  marker_ = {};
  ++markers_found_;
}

template <std::size_t n>
void Su2Reader::read_elements(int wanted, GlobalIndex count,
                              std::vector<std::array<GlobalIndex, n>>& elements) {
  reserve_more(elements, std::min(count, in_.capacity({.ints = 1, .longs = n})), in_);
  for (GlobalIndex i = 0; i < count; ++i) {
    const ElementType& type = read_element_type();
    if (type.number == wanted) {
      std::array<GlobalIndex, n>& points = append(elements, {}, in_);
      for (GlobalIndex& point : points) point = read_point_id();
    } else {
      mesh_.refuse(type.plural, 1);
      for (int k = 0; k < type.nodes; ++k) read_point_id();
    }
    read_index();
    end_record();
  }
}

const ElementType& Su2Reader::read_element_type() {
  const int number = in_.read_int("an element type");
  for (const ElementType& type : element_types)
    if (type.number == number) return type;
  in_.fail("elements of SU2's type " + std::to_string(number) + " are not known",
           "only tetrahedra (10) and, in markers, triangles (5) can be used");
}

GlobalIndex Su2Reader::read_point_id() {
  const GlobalIndex point = in_.read_long("a point id");
  if (point < 0 || point >= point_count_)
    in_.fail("an element uses point " + std::to_string(point) + " of " + std::to_string(point_count_),
             "SU2 numbers points from 0");
  return point;
}

/// The index that may close a line.
std::optional<GlobalIndex> Su2Reader::read_index() {
  if (in_.at_end_of_line()) return std::nullopt;
  return in_.read_long("an index");
}

void Su2Reader::end_record() {
  if (in_.at_end_of_line()) return;
  const std::string_view word = in_.read_word();
  in_.fail("the line should end before " + quoted(word), rewrite);
}

/// Passes over the data of a keyword that is of no use here: the lines up to the next keyword.
void Su2Reader::pass_over_data() {
  do {
    in_.read_line();
  } while (!in_.at_end() && in_.peek_line().find('=') == std::string_view::npos);
}

}  // namespace

Mesh read_su2(std::string_view content, const std::string& file) {
  return Su2Reader(content, file).read();
}

}  // namespace alphadot
