#include "io/cgns/cgns_reader.hpp"

#include <cgnslib.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/bounded_growth.hpp"
#include "io/foreign_files.hpp"
#include "io/mesh_builder.hpp"

namespace alphadot {
namespace {

using ElementType = CGNS_ENUMT(ElementType_t);

constexpr auto mixed = CGNS_ENUMV(MIXED);
constexpr const char* rewrite = "the file is damaged: write it again";
constexpr const char* one_zone = "export the mesh as one unstructured zone";

/// Names in a CGNS file have 32 characters; those of families may be paths of them.
using Name = std::array<char, 1024>;

/// Points or elements that are read at a time, so that the mesh is in memory once, not twice.
constexpr std::int64_t piece = 65536;

/// A type of elements. Corners come first among the nodes; their order is that of Shape.
struct Kind {
  std::string name;            ///< the standard's, such as HEXA_20
  std::int64_t nodes = 0;      ///< none where elements of a type have different numbers of them
  std::optional<Shape> shape;  ///< none for points and lines, which are passed over, and for polyhedra

  bool is_polyhedral() const { return name == "NGON_n" || name == "NFACE_n"; }
  bool is_surface() const { return shape == Shape::triangle || shape == Shape::quadrilateral; }
  bool is_curved() const { return shape && nodes > static_cast<std::int64_t>(corner_count(*shape)); }
};

/// The kind of a type; nothing for one that the standard does not have.
std::optional<Kind> kind_of(ElementType type) {
  int nodes = 0;
  if (type <= 0 || type >= NofValidElementTypes || type == mixed || cg_npe(type, &nodes) != CG_OK)
    return std::nullopt;
  Kind out{cg_ElementTypeName(type), std::max(nodes, 0), std::nullopt};
  constexpr std::array<std::pair<std::string_view, Shape>, 6> shapes{{{"TRI_", Shape::triangle},
                                                                      {"QUAD_", Shape::quadrilateral},
                                                                      {"TETRA_", Shape::tetrahedron},
                                                                      {"PYRA_", Shape::pyramid},
                                                                      {"PENTA_", Shape::prism},
                                                                      {"HEXA_", Shape::hexahedron}}};
  for (const auto& [beginning, shape] : shapes)
    if (out.name.starts_with(beginning)) out.shape = shape;
  if (out.nodes == 0 && !out.is_polyhedral()) return std::nullopt;
  return out;
}

class CgnsReader {
 public:
  CgnsReader(const std::string& path, const std::function<void(const std::string&)>& tell);
  ~CgnsReader() { cg_close(file_); }
  CgnsReader(const CgnsReader&) = delete;
  CgnsReader& operator=(const CgnsReader&) = delete;

  MeshOfFile read() &&;

  /// Bytes of the file.
  std::size_t size() const { return static_cast<std::size_t>(bytes_); }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy = rewrite) const {
    throw InputError(path_, 0, what, remedy);
  }

 private:
  struct Section {
    int index = 0;  ///< the library's
    std::string name;
    ElementType type{};
    cgsize_t first = 0, last = 0;  ///< its elements
  };
  /// What is known of a face besides its points. Apart from them, so that no array is out of proportion.
  struct Label {
    cgsize_t element = 0;   ///< its number in the zone
    std::int32_t name = 0;  ///< in names_
    bool is_triangle = true, has_condition = false;
  };

  /// Throws what the library says when `status` tells of an error.
  void check(int status) const {
    if (status != CG_OK)
      fail(fmt::format("the CGNS library says: {}", cg_get_error()),
           fmt::format("is the file damaged, or newer than CGNS {:.1f}?", CGNS_VERSION / 1000.0));
  }
  /// No count in a file is trusted: `count` numbers of `bytes` must have room in it.
  void check_size(std::int64_t count, std::int64_t bytes, const std::string& what) const;
  void choose_zone();
  void read_points();
  std::vector<Section> sections_in_order() const;
  void read_sections();
  void read_section(const Section& section);
  void read_mixed(const Section& section, const std::vector<cgsize_t>& entries);
  [[noreturn]] void fail_of_polyhedra(const Section& section, const std::string& type) const;
  void add_element(const Kind& kind, const cgsize_t* points, cgsize_t number, const std::string& section);
  void read_conditions();
  void read_condition(int condition);
  std::string family_of(int condition) const;
  Label& label_of(cgsize_t element, const std::string& condition);
  std::int32_t index_of(const std::string& name);
  void make_patches();

  std::string path_;
  const std::function<void(const std::string&)>& tell_;
  std::int64_t bytes_;  ///< length of the file
  int file_ = 0, base_ = 1, zone_ = 1;
  cgsize_t point_count_ = 0;
  MeshBuilder mesh_;
  std::vector<std::array<GlobalIndex, 3>> triangles_;       ///< points, in the order of the elements
  std::vector<std::array<GlobalIndex, 4>> quadrilaterals_;  ///< the same
  std::vector<Label> labels_;                               ///< of each of both, in the order of the elements
  std::vector<std::string> names_;
};

CgnsReader::CgnsReader(const std::string& path, const std::function<void(const std::string&)>& tell)
    : path_(path), tell_(tell), mesh_(path) {
  std::error_code error;
  bytes_ = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  if (error) fail("cannot read the file: " + error.message(), "check the path and its permissions");
  int type = 0;
  if (cg_is_cgns(path.c_str(), &type) != CG_OK) {
    if (const auto problem = foreign_content(path, beginning_of(path), Expected::text))
      throw InputError(std::vector{*problem});
    fail("this is no CGNS file, or it is cut short", "check that it was written to the end");
  }
  check(cg_open(path.c_str(), CG_MODE_READ, &file_));
}

MeshOfFile CgnsReader::read() && {
  choose_zone();
  read_points();
  read_sections();
  read_conditions();
  make_patches();
  return std::move(mesh_).finish("write the volume elements too, not only the surface");
}

void CgnsReader::check_size(std::int64_t count, std::int64_t bytes, const std::string& what) const {
  if (count < 0 || count > bytes_ / bytes)
    fail(fmt::format("{} has {} numbers, more than the file has room for", what, count),
         "the file is damaged, or compressed: h5repack -f NONE takes the compression out");
}

void CgnsReader::choose_zone() {
  int bases = 0, zones = 0, cell_dimension = 0, dimension = 0;
  check(cg_nbases(file_, &bases));
  if (bases != 1) fail(fmt::format("the file holds {} bases", bases), "write one base a file");
  Name name{};
  check(cg_base_read(file_, base_, name.data(), &cell_dimension, &dimension));
  if (cell_dimension != 3 || dimension != 3)
    fail(fmt::format("base {} has cells of dimension {} in space of dimension {}", name.data(),
                     cell_dimension, dimension),
         "only volume meshes in three dimensions can be used");

  check(cg_nzones(file_, base_, &zones));
  if (zones == 0) fail("the file holds no zone", "write the mesh into it");
  std::vector<std::string> found;
  for (int zone = 1; zone <= zones; ++zone) {
    std::array<cgsize_t, 9> size{};
    CGNS_ENUMT(ZoneType_t) type{};
    check(cg_zone_read(file_, base_, zone, name.data(), size.data()));
    check(cg_zone_type(file_, base_, zone, &type));
    if (type != CGNS_ENUMV(Unstructured))
      fail(fmt::format("zone {} is {}", name.data(), cg_ZoneTypeName(type)), one_zone);
    found.emplace_back(name.data());
    point_count_ = size[0];
  }
  if (zones > 1) fail(fmt::format("the file holds {} zones: {}", zones, fmt::join(found, ", ")), one_zone);
}

void CgnsReader::read_points() {
  int coordinates = 0;
  check(cg_ncoords(file_, base_, zone_, &coordinates));
  std::set<std::string> names;
  for (int i = 1; i <= coordinates; ++i) {
    Name name{};
    CGNS_ENUMT(DataType_t) type{};
    check(cg_coord_info(file_, base_, zone_, i, &type, name.data()));
    names.insert(name.data());
  }
  const std::array<const char*, 3> axes{"CoordinateX", "CoordinateY", "CoordinateZ"};
  if (!std::ranges::all_of(axes, [&](const char* axis) { return names.contains(axis); }))
    fail(fmt::format("the coordinates are \"{}\"", fmt::join(names, ", ")),
         "only Cartesian CoordinateX, CoordinateY and CoordinateZ can be used");

  check_size(point_count_, 3 * 4, "the list of points");
  mesh_.points().resize(static_cast<std::size_t>(point_count_));
  std::vector<double> values(std::min<std::size_t>(mesh_.points().size(), piece));
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int64_t before = 0; before < point_count_; before += piece) {
      const auto first = static_cast<cgsize_t>(before + 1),
                 last = static_cast<cgsize_t>(std::min<std::int64_t>(before + piece, point_count_));
      check(cg_coord_read(file_, base_, zone_, axes[static_cast<std::size_t>(axis)], CGNS_ENUMV(RealDouble),
                          &first, &last, values.data()));
      for (std::int64_t i = before; i < last; ++i)
        mesh_.points()[static_cast<std::size_t>(i)][axis] = values[static_cast<std::size_t>(i - before)];
    }
  }
}

/// Sections by the numbers of their elements, which no two share.
std::vector<CgnsReader::Section> CgnsReader::sections_in_order() const {
  int count = 0;
  check(cg_nsections(file_, base_, zone_, &count));
  std::vector<Section> out;
  for (int index = 1; index <= count; ++index) {
    Name name{};
    Section section;
    int boundary = 0, has_parents = 0;
    check(cg_section_read(file_, base_, zone_, index, name.data(), &section.type, &section.first,
                          &section.last, &boundary, &has_parents));
    section.index = index;
    section.name = name.data();
    if (section.first < 1 || section.last < section.first)
      fail(fmt::format("section {} has elements {} to {}", section.name, section.first, section.last));
    append(out, section, *this);
  }
  std::ranges::stable_sort(out, {}, &Section::first);
  for (std::size_t i = 1; i < out.size(); ++i)
    if (out[i].first <= out[i - 1].last)
      fail(fmt::format("sections {} and {} both have an element {}", out[i - 1].name, out[i].name,
                       out[i].first));
  return out;
}

void CgnsReader::read_sections() {
  for (const Section& section : sections_in_order()) read_section(section);
}

void CgnsReader::fail_of_polyhedra(const Section& section, const std::string& type) const {
  fail(fmt::format("section {} holds {} elements: the mesh is of polyhedra, which are not read", section.name,
                   type),
       "export it with tetrahedra, pyramids, prisms and hexahedra (TETRA_4, PYRA_5, PENTA_6, HEXA_8), which "
       "a mesh made of these can be");
}

void CgnsReader::read_section(const Section& section) {
  const auto kind = kind_of(section.type);
  if (kind && kind->is_polyhedral()) fail_of_polyhedra(section, kind->name);
  if (kind && !kind->shape) return;
  if (!kind && section.type != mixed)
    fail(fmt::format("section {} has elements of the unknown type {}", section.name,
                     static_cast<int>(section.type)));
  cgsize_t size = 0;
  check(cg_ElementDataSize(file_, base_, zone_, section.index, &size));
  check_size(size, 4, fmt::format("section {}", section.name));
  if (section.type == mixed) {
    std::vector<cgsize_t> entries(static_cast<std::size_t>(size));
    check(cg_poly_elements_read(file_, base_, zone_, section.index, entries.data(), nullptr, nullptr));
    return read_mixed(section, entries);
  }
  const auto count = std::int64_t{section.last} - section.first + 1;
  if (count > size || count * kind->nodes != size)
    fail(fmt::format("section {} has {} elements in {} numbers", section.name, count, size));
  const auto reserve = [&](auto& elements) { reserve_more(elements, count, *this); };
  mesh_.with_volumes(*kind->shape, reserve);
  if (kind->shape == Shape::triangle) reserve(triangles_);
  if (kind->shape == Shape::quadrilateral) reserve(quadrilaterals_);
  std::vector<cgsize_t> entries(static_cast<std::size_t>(std::min(count, piece) * kind->nodes));
  for (std::int64_t first = section.first; first <= section.last; first += piece) {
    const auto last = std::min<std::int64_t>(first + piece - 1, section.last);
    check(cg_elements_partial_read(file_, base_, zone_, section.index, static_cast<cgsize_t>(first),
                                   static_cast<cgsize_t>(last), entries.data(), nullptr));
    for (std::int64_t number = first; number <= last; ++number)
      add_element(*kind, entries.data() + (number - first) * kind->nodes, static_cast<cgsize_t>(number),
                  section.name);
  }
}

/// Elements of several types, each behind the number of its type.
void CgnsReader::read_mixed(const Section& section, const std::vector<cgsize_t>& entries) {
  std::size_t at = 0;
  ElementType type{};
  std::optional<Kind> kind;
  for (std::int64_t number = section.first; number <= section.last; ++number) {
    if (at == entries.size()) fail(fmt::format("section {} ends before element {}", section.name, number));
    const auto next = static_cast<ElementType>(entries[at++]);
    if (next != type) kind = kind_of(next);
    type = next;
    if (kind && kind->is_polyhedral()) fail_of_polyhedra(section, kind->name);
    if (!kind)
      fail(fmt::format("element {} in section {} has the unknown type {}", number, section.name,
                       entries[at - 1]));
    if (static_cast<std::size_t>(kind->nodes) > entries.size() - at)
      fail(fmt::format("section {} ends inside element {}", section.name, number));
    add_element(*kind, entries.data() + at, static_cast<cgsize_t>(number), section.name);
    at += static_cast<std::size_t>(kind->nodes);
  }
}

void CgnsReader::add_element(const Kind& kind, const cgsize_t* points, cgsize_t number,
                             const std::string& section) {
  if (!kind.shape) return;
  const auto add = [&](auto& elements) {
    auto& ids = append(elements, {}, *this);
    for (std::size_t k = 0; k < ids.size(); ++k) {
      if (points[k] < 1 || points[k] > point_count_)
        fail(fmt::format("element {} in section {} uses point {} of {}", number, section, points[k],
                         point_count_));
      ids[k] = points[k] - 1;
    }
  };
  if (!kind.is_surface()) {
    mesh_.begin_volume(section);
    if (kind.is_curved()) mesh_.add_curved(1);
    return mesh_.with_volumes(*kind.shape, add);
  }
  const bool is_triangle = kind.shape == Shape::triangle;
  if (is_triangle)
    add(triangles_);
  else
    add(quadrilaterals_);
  append(labels_, {number, index_of(section), is_triangle, false}, *this);
}

void CgnsReader::read_conditions() {
  int conditions = 0;
  check(cg_nbocos(file_, base_, zone_, &conditions));
  for (int condition = 1; condition <= conditions; ++condition) read_condition(condition);
}

void CgnsReader::read_condition(int condition) {
  Name name{};
  CGNS_ENUMT(BCType_t) kind{};
  CGNS_ENUMT(PointSetType_t) set{};
  CGNS_ENUMT(DataType_t) normal_type{};
  CGNS_ENUMT(GridLocation_t) location{};
  cgsize_t size = 0, normal_size = 0;
  int normal_index[3] = {}, data_sets = 0;
  check(cg_boco_info(file_, base_, zone_, condition, name.data(), &kind, &set, &size, normal_index,
                     &normal_size, &normal_type, &data_sets));
  check(cg_boco_gridlocation_read(file_, base_, zone_, condition, &location));
  const bool is_range = set == CGNS_ENUMV(PointRange) || set == CGNS_ENUMV(ElementRange);
  const bool is_elements =
      set == CGNS_ENUMV(ElementRange) || set == CGNS_ENUMV(ElementList) || location == CGNS_ENUMV(FaceCenter);
  if (!is_elements)
    return tell_(
        fmt::format("boundary condition {} is given by {}, not by faces: passed over, its faces keep the "
                    "names of their sections",
                    name.data(), cg_GridLocationName(location)));
  check_size(size, 4, fmt::format("boundary condition {}", name.data()));
  if (is_range && size != 2)
    fail(fmt::format("boundary condition {} has a range of {} ends", name.data(), size));
  std::vector<cgsize_t> elements(static_cast<std::size_t>(size));
  check(cg_boco_read(file_, base_, zone_, condition, elements.data(), nullptr));
  if (is_range) {
    const auto [first, last] = std::pair(elements[0], elements[1]);
    if (first > last || std::int64_t{last} - first >= std::ssize(labels_))
      fail(fmt::format("boundary condition {} has elements {} to {}", name.data(), first, last));
    elements.resize(static_cast<std::size_t>(last - first) + 1);
    std::iota(elements.begin(), elements.end(), first);
  }
  const auto family = family_of(condition);
  const auto index = index_of(family.empty() ? name.data() : family);
  for (const auto element : elements) {
    Label& found = label_of(element, name.data());
    if (found.has_condition && found.name != index)
      fail(fmt::format("element {} belongs to two boundary conditions, {} and {}", element,
                       names_[static_cast<std::size_t>(found.name)], names_[static_cast<std::size_t>(index)]),
           "give every face one");
    found.has_condition = true;
    found.name = index;
  }
}

/// The name of a condition's family, or nothing.
std::string CgnsReader::family_of(int condition) const {
  check(cg_goto(file_, base_, "Zone_t", zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
  Name name{};
  const int status = cg_famname_read(name.data());
  if (status == CG_NODE_NOT_FOUND) return "";
  check(status);
  return name.data();
}

CgnsReader::Label& CgnsReader::label_of(cgsize_t element, const std::string& condition) {
  const auto found = std::ranges::lower_bound(labels_, element, {}, &Label::element);
  if (found == labels_.end() || found->element != element)
    fail(fmt::format("boundary condition {} lists element {}, which is no face", condition, element));
  return *found;
}

std::int32_t CgnsReader::index_of(const std::string& name) {
  if (!names_.empty() && names_.back() == name) return static_cast<std::int32_t>(names_.size() - 1);
  const auto index = std::ranges::find(names_, name) - names_.begin();
  if (index == std::ssize(names_)) names_.push_back(name);
  return static_cast<std::int32_t>(index);
}

/// Patches in the order of their first faces.
void CgnsReader::make_patches() {
  std::vector<std::array<GlobalIndex, 2>> counts(names_.size());  // triangles and quadrilaterals
  for (const Label& label : labels_)
    ++counts[static_cast<std::size_t>(label.name)][label.is_triangle ? 0 : 1];
  auto triangle = triangles_.begin();
  auto quadrilateral = quadrilaterals_.begin();
  for (const Label& label : labels_) {
    const auto name = static_cast<std::size_t>(label.name);
    Surface& surface = mesh_.surface(names_[name], *this);
    reserve_more(surface.triangles, std::exchange(counts[name][0], 0), *this);
    reserve_more(surface.quadrilaterals, std::exchange(counts[name][1], 0), *this);
    if (label.is_triangle)
      append(surface.triangles, *triangle++, *this);
    else
      append(surface.quadrilaterals, *quadrilateral++, *this);
  }
}

}  // namespace

MeshOfFile read_cgns(const std::string& path, const std::function<void(const std::string&)>& tell) {
  return CgnsReader(path, tell).read();
}

}  // namespace alphadot
