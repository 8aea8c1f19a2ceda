#include "io/su2_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "io/mesh_builder.hpp"
#include "io/scanner.hpp"

namespace alphadot {
namespace {

constexpr const char* rewrite = "the file is damaged: write it again";

/// One of the element types of SU2, which are those of VTK.
struct ElementType {
  int number;
  Shape shape;
};
constexpr std::array<ElementType, 4> volume_types{
    {{10, Shape::tetrahedron}, {12, Shape::hexahedron}, {13, Shape::prism}, {14, Shape::pyramid}}};
constexpr std::array<ElementType, 2> surface_types{{{5, Shape::triangle}, {9, Shape::quadrilateral}}};

/// What old files of partitioned runs have in the place of a name.
constexpr std::string_view halo_marker = "SEND_RECEIVE";

class Su2Reader {
 public:
  Su2Reader(std::string_view content, const std::string& file)
      : in_(content, file, '%'), mesh_(file), point_count_(find_point_count(in_)) {}

  MeshOfFile read();

 private:
  static GlobalIndex find_point_count(Scanner in);
  void read_section();
  void read_points();
  void read_cells();
  void read_marker_tag();
  void read_marker_elements();
  void read_halo_marker(GlobalIndex count);
  Shape read_shape(std::span<const ElementType> known, const char* remedy);
  template <std::size_t n>
  void read_element(std::vector<std::array<GlobalIndex, n>>& elements, GlobalIndex left);
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
  GlobalIndex halo_markers_ = 0;
};

/// Elements usually come before the points; so that their point ids can be checked where they stand, the
/// number of points is looked up first.
GlobalIndex Su2Reader::find_point_count(Scanner in) {
  in.skip_byte_order_mark();
  for (; !in.at_end(); in.read_line())
    if (in.read_word('=') == "NPOIN" && in.accept('=')) return in.read_long("the number of points");
  in.fail("there is no NPOIN section", "write the points, or check that this is an SU2 mesh");
}

MeshOfFile Su2Reader::read() {
  in_.skip_byte_order_mark();
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
  if (halo_markers_ > 0)
    mesh_.note(std::to_string(halo_markers_) + " markers SEND_RECEIVE of an old file have been passed over");
  return std::move(mesh_).finish("write the volume elements into its NELEM section");
}

void Su2Reader::read_section() {
  const std::string_view keyword = in_.read_word('=');
  if (keyword.empty() || !in_.accept('='))
    in_.fail("a keyword such as NELEM= should stand here, not " + quoted(keyword),
             "check that the section before it is as long as announced");
  if (keyword == "NDIME") {
    const int dimension = in_.read_int("the dimension");
    if (dimension == 2)
      in_.fail("the mesh is two-dimensional (NDIME= 2)",
               "alphadot computes flows in three dimensions: extrude the mesh by one layer, with a symmetry "
               "patch on either side");
    if (dimension != 3) in_.fail("the mesh is not three-dimensional", "only NDIME= 3 can be used");
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
  const GlobalIndex count = in_.read_long_count("the number of elements", {.ints = 1, .longs = 4});
  for (GlobalIndex i = 0; i < count; ++i) {
    const Shape shape = read_shape(
        volume_types, "volumes are of tetrahedra (10), hexahedra (12), prisms (13) and pyramids (14)");
    mesh_.with_volumes(shape, [&](auto& elements) { read_element(elements, count - i); });
  }
}

/// A name is what stands on the line: it may hold blanks, and quotes around it are no part of it.
void Su2Reader::read_marker_tag() {
  if (!marker_.empty()) in_.fail("marker " + quoted(marker_) + " has no MARKER_ELEMS", rewrite);
  if (in_.at_end_of_line()) in_.fail("a marker has no name", "write MARKER_TAG= name");
  marker_ = in_.read_rest_of_line();
  for (const char quote : {'"', '\''})
    if (marker_.size() > 2 && marker_.starts_with(quote) && marker_.ends_with(quote))
      marker_ = marker_.substr(1, marker_.size() - 2);
  if (mesh_.has_surface(marker_))
    in_.fail("a second marker " + quoted(marker_), "give every marker a name of its own");
}

void Su2Reader::read_marker_elements() {
  if (marker_.empty()) in_.fail("MARKER_ELEMS without a MARKER_TAG before it", rewrite);
  if (marker_ == halo_marker) {
    read_halo_marker(in_.read_long_count("the number of marker elements", {.ints = 2}));
  } else {
    const GlobalIndex count = in_.read_long_count("the number of marker elements", {.ints = 1, .longs = 3});
    Surface& surface = mesh_.surface(marker_, in_);
    for (GlobalIndex i = 0; i < count; ++i) {
      const Shape shape = read_shape(surface_types, "markers are of triangles (5) and quadrilaterals (9)");
      MeshBuilder::with_faces(shape, surface, [&](auto& elements) { read_element(elements, count - i); });
    }
  }
  marker_ = {};
  ++markers_found_;
}

/// Points that another rank or a periodic side would send: nothing of the boundary.
void Su2Reader::read_halo_marker(GlobalIndex count) {
  end_record();
  in_.read_line();
  if (in_.peek_line().find("SEND_TO") != std::string_view::npos) in_.read_line();
  for (GlobalIndex i = 0; i < count && !in_.at_end(); ++i) in_.read_line();
  ++halo_markers_;
}

Shape Su2Reader::read_shape(std::span<const ElementType> known, const char* remedy) {
  const int number = in_.read_int("an element type");
  for (const ElementType& type : known)
    if (type.number == number) return type.shape;
  constexpr int first_curved = 21, last_curved = 37;  // VTK's, as Gmsh writes them into such files
  if (number >= first_curved && number <= last_curved)
    in_.fail("elements of second order, type " + std::to_string(number) + ", which SU2 does not have",
             "write the mesh with elements of first order, in Gmsh by Mesh.ElementOrder = 1");
  in_.fail("elements of SU2's type " + std::to_string(number) + " cannot stand here", remedy);
}

/// Reads an element, the first of `left` that are probably alike.
template <std::size_t n>
void Su2Reader::read_element(std::vector<std::array<GlobalIndex, n>>& elements, GlobalIndex left) {
  if (elements.empty()) reserve_more(elements, std::min(left, in_.capacity({.longs = n})), in_);
  std::array<GlobalIndex, n>& points = append(elements, {}, in_);
  for (GlobalIndex& point : points) point = read_point_id();
  read_index();
  end_record();
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

MeshOfFile read_su2(std::string_view content, const std::string& file) {
  return Su2Reader(content, file).read();
}

}  // namespace alphadot
