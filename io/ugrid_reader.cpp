#include "io/ugrid_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/mesh_builder.hpp"

namespace alphadot {
namespace {

constexpr const char* damaged = "the file is damaged or was not written completely: write it again";

/// The first seven integers of the file.
struct Header {
  GlobalIndex points = 0, triangles = 0, quadrilaterals = 0, tetrahedra = 0, pyramids = 0, prisms = 0,
              hexahedra = 0;

  std::array<GlobalIndex, 7> counts() const {
    return {points, triangles, quadrilaterals, tetrahedra, pyramids, prisms, hexahedra};
  }
  GlobalIndex faces() const { return triangles + quadrilaterals; }
  GlobalIndex ints() const {
    return (3 + 1) * triangles + (4 + 1) * quadrilaterals + 4 * tetrahedra + 5 * pyramids + 6 * prisms +
           8 * hexahedra;
  }
};

Header read_header(Scanner& in) {
  const char* const meaning = "one of the seven counts of the header";
  Header header;
  for (GlobalIndex* count : {&header.points, &header.triangles, &header.quadrilaterals, &header.tetrahedra,
                             &header.pyramids, &header.prisms, &header.hexahedra})
    *count = in.read_int(meaning);
  return header;
}

/// Reads the header, with the lengths of its record and of the next where there are any.
class Beginning {
 public:
  Beginning(Scanner& in, const UgridForm& form) {
    in.set_encoding(form.encoding);
    if (form.single_reals) in.set_single_reals();
    const bool has_records = looks_recorded(in);
    if (form.fortran_records) begin_ = in.read_int("the length of a record");
    header_ = read_header(in);
    if (form.fortran_records) {
      end_ = in.read_int("the length of a record");
      in.read_int("the length of a record");  // beyond 2 GB it tells nothing
    }
    const auto counts = header_.counts();
    // Text has two characters a number at least, and may end without a blank.
    const GlobalIndex int_bytes = form.encoding == Encoding::text ? 2 : 4,
                      real_bytes = form.encoding == Encoding::text ? 2
                                   : form.single_reals             ? 4
                                                                   : 8;
    const bool positive = std::all_of(counts.begin(), counts.end(), [](GlobalIndex n) { return n >= 0; });
    const GlobalIndex bytes = 3 * real_bytes * header_.points + int_bytes * header_.ints();
    const auto left = static_cast<GlobalIndex>(in.remaining());
    fits_ = positive && begin_ == end_ && has_records == form.fortran_records && bytes <= left + 1;
    fills_ = fits_ && bytes + (form.fortran_records ? 4 : 0) == left;
  }

  const Header& header() const { return header_; }
  /// Whether the rest of the file can hold what the header announces.
  bool fits() const { return fits_; }
  /// Whether what it announces, in binary, is all that follows.
  bool fills() const { return fills_; }

 private:
  /// Whether the length of the header's record stands before and behind it.
  static bool looks_recorded(Scanner in) {
    constexpr std::size_t length = 28;
    if (in.encoding() == Encoding::text || in.remaining() < length + 8) return false;
    const bool before = in.read_int("the length of a record") == length;
    in.skip(length);
    return before && in.read_int("the length of a record") == length;
  }

  Header header_;
  std::int32_t begin_ = 0, end_ = 0;
  bool fits_, fills_;
};

struct KnownForm {
  std::string_view extension;
  UgridForm form;
};
constexpr std::array<KnownForm, 9> known_forms{{{".b8.ugrid", {Encoding::big_endian, false, false}},
                                                {".lb8.ugrid", {Encoding::little_endian, false, false}},
                                                {".b4.ugrid", {Encoding::big_endian, true, false}},
                                                {".lb4.ugrid", {Encoding::little_endian, true, false}},
                                                {".r8.ugrid", {Encoding::big_endian, false, true}},
                                                {".lr8.ugrid", {Encoding::little_endian, false, true}},
                                                {".r4.ugrid", {Encoding::big_endian, true, true}},
                                                {".lr4.ugrid", {Encoding::little_endian, true, true}},
                                                {".ugrid", {Encoding::text, false, false}}}};

constexpr std::size_t most_of_beginning = 40;  // bytes of a binary header and of the lengths of records

/// The binary form in which the numbers that a header announces fill the file; or else one in which it can
/// hold them, of the precision asked for, for a file that is cut could hold them in single precision.
const KnownForm* binary_form_of(std::string_view content, const std::string& file, bool single_reals,
                                bool& fills) {
  const KnownForm* out = nullptr;
  fills = false;
  for (const KnownForm& known : known_forms) {
    if (known.form.encoding == Encoding::text || content.size() < most_of_beginning) continue;
    Scanner in(content, file);
    const Beginning beginning(in, known.form);
    fills = beginning.fills();
    if (fills) return &known;
    if (beginning.fits() && known.form.single_reals == single_reals && out == nullptr) out = &known;
  }
  return out;
}

[[noreturn]] void fail_as(const KnownForm& known, const Scanner& in) {
  const auto& [encoding, single_reals, fortran_records] = known.form;
  in.fail_at(0,
             std::string("the numbers are in ") + (encoding == Encoding::little_endian ? "little" : "big") +
                 "-endian order, coordinates of " + (single_reals ? "single" : "double") + " precision" +
                 (fortran_records ? ", in Fortran's records" : ""),
             "give the file the extension " + std::string(known.extension));
}

/// Reads the header; where it cannot be, tells the form in which it could.
Header read_beginning(Scanner& in, const UgridForm& form, std::string_view content) {
  const std::string_view start = content.substr(0, most_of_beginning);
  const bool is_text = form.encoding == Encoding::text;
  bool fills = false;
  const KnownForm* const known = binary_form_of(content, in.file(), form.single_reals, fills);
  if (is_text && start.find('\0') != std::string_view::npos) {
    if (known) fail_as(*known, in);
    in.fail_at(0, "the file is binary, and .ugrid alone is for text",
               "give it the extension of its form, .b8.ugrid or .lb8.ugrid for example");
  }
  if (!is_text && !start.empty() &&
      start.find_first_not_of("0123456789+-.eE \t\r\n") == std::string_view::npos)
    in.fail_at(0, "the numbers are written as text", "give the file the extension .ugrid");
  const Beginning beginning(in, form);
  if (!is_text && known && known->form != form && (fills || !beginning.fits())) fail_as(*known, in);
  if (beginning.fits()) return beginning.header();
  in.fail_at(0, "the header announces more than the " + std::to_string(content.size()) + " bytes of the file",
             damaged);
}

GlobalIndex read_point(Scanner& in, GlobalIndex point_count) {
  const GlobalIndex id = in.read_int("a point id");
  if (id < 1 || id > point_count)
    in.fail("an element uses point " + std::to_string(id) + " of " + std::to_string(point_count), damaged);
  return id - 1;
}

/// The point ids of one element. In the file they start from 1.
template <std::size_t n>
std::array<GlobalIndex, n> read_element(Scanner& in, GlobalIndex point_count) {
  std::array<GlobalIndex, n> points;
  for (GlobalIndex& point : points) point = read_point(in, point_count);
  // A pyramid has its apex in the middle: 1 4 5 2 go round its base and 3 is the apex.
  if constexpr (n == 5) points = {points[0], points[3], points[4], points[1], points[2]};
  return points;
}

/// Reads the boundary: triangles, quadrilaterals, then the surface ids of both.
void read_boundary(Scanner& in, const Header& header, const SurfaceNames& names, MeshBuilder& mesh) {
  Scanner ids = in;
  if (in.encoding() == Encoding::text)
    for (GlobalIndex i = 0; i < 3 * header.triangles + 4 * header.quadrilaterals; ++i)
      ids.read_int("a point id");
  else
    ids.skip(static_cast<std::size_t>(4 * (3 * header.triangles + 4 * header.quadrilaterals)));
  Surface* surface = nullptr;
  std::int32_t id_of_surface = 0;
  for (GlobalIndex i = 0; i < header.faces(); ++i) {
    const std::int32_t id = ids.read_int("a surface id");
    if (surface == nullptr || id != id_of_surface) {
      const auto name = names.find(id);
      surface = &mesh.surface(name != names.end() ? name->second : "patch_" + std::to_string(id), ids);
      id_of_surface = id;
    }
    if (i < header.triangles)
      append(surface->triangles, read_element<3>(in, header.points), ids);
    else
      append(surface->quadrilaterals, read_element<4>(in, header.points), ids);
  }
  in = ids;
}

/// The name in what stands behind the numbers of a line.
std::string name_in(std::string_view rest) {
  const auto trimmed = [](std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
  };
  const std::size_t remark = rest.find_first_of("!#");
  std::string_view name = trimmed(rest.substr(0, remark));
  if (name.empty() && remark != std::string_view::npos) name = trimmed(rest.substr(remark + 1));
  return std::string(name);
}

/// Passes over lines that are empty or a comment.
void skip_comment_lines(Scanner& in) {
  while (!in.at_end() && (in.peek_line().starts_with('#') || in.peek_line().starts_with('!'))) in.read_line();
}

/// Reads "id condition ... name" with `numbers` numbers before the name.
void read_mapbc_line(Scanner& in, int numbers, SurfaceNames& names) {
  const std::int32_t id = in.read_int("a surface id");
  for (int i = 1; i < numbers; ++i) in.read_int("a boundary condition");
  const std::string name = name_in(in.read_rest_of_line());
  if (!name.empty()) names[id] = name;
}

}  // namespace

std::optional<UgridForm> ugrid_form(std::string_view name) {
  for (const auto& [extension, form] : known_forms)
    if (name.ends_with(extension)) return form;
  return std::nullopt;
}

MeshOfFile read_ugrid(std::string_view content, const std::string& file, const UgridForm& form,
                      const SurfaceNames& names) {
  Scanner in(content, file);
  if (form.encoding == Encoding::text) in.skip_byte_order_mark();
  const Header header = read_beginning(in, form, content);

  MeshBuilder mesh(file);
  reserve_more(mesh.points(), header.points, in);
  for (GlobalIndex i = 0; i < header.points; ++i) append(mesh.points(), read_coordinates(in), in);
  read_boundary(in, header, names, mesh);
  const std::pair<Shape, GlobalIndex> volumes[] = {{Shape::tetrahedron, header.tetrahedra},
                                                   {Shape::pyramid, header.pyramids},
                                                   {Shape::prism, header.prisms},
                                                   {Shape::hexahedron, header.hexahedra}};
  for (const auto& [shape, count] : volumes)
    mesh.with_volumes(shape, [&, size = count](auto& elements) {
      constexpr std::size_t n = std::tuple_size_v<typename std::decay_t<decltype(elements)>::value_type>;
      reserve_more(elements, size, in);
      for (GlobalIndex i = 0; i < size; ++i) append(elements, read_element<n>(in, header.points), in);
    });
  return std::move(mesh).finish("write its volume elements");
}

SurfaceNames read_mapbc(std::string_view content, const std::string& file) {
  Scanner in(content, file);
  in.skip_byte_order_mark();
  const bool of_usm3d = in.peek_line().starts_with('#');
  skip_comment_lines(in);
  SurfaceNames names;
  if (of_usm3d) {
    for (; !in.at_end(); skip_comment_lines(in)) read_mapbc_line(in, 5, names);
    return names;
  }
  const GlobalIndex count = in.read_int_count("the number of surfaces", {.ints = 2});
  in.read_line();
  for (GlobalIndex i = 0; i < count; ++i) {
    skip_comment_lines(in);
    read_mapbc_line(in, 2, names);
  }
  return names;
}

}  // namespace alphadot
