// Writes meshes of mixed elements in every format and dialect that the readers know, by the formats'
// descriptions.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "io/readers/small_meshes.hpp"
#include "io/ugrid_reader.hpp"
#include "support/mixed_mesh.hpp"

namespace alphadot::test {

using testing_support::MixedElement;
using testing_support::MixedMesh;

inline constexpr std::array<const char*, 6> side_names{"inlet side", "outlet", "far.field",
                                                       "body",       "lid",    "floor"};

/// The shortest decimals that give the same bits back, as `exponent` writes them: 1.5 or 1.5D+00.
inline std::string decimal(double value, char exponent = '\0') {
  std::array<char, 64> text;
  const auto format = exponent != '\0' ? std::chars_format::scientific : std::chars_format::general;
  std::string out(text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format).ptr);
  if (exponent != '\0') out[out.find('e')] = exponent;
  return out;
}

struct GmshDialect {
  const char* version = "4.1";
  Encoding encoding = Encoding::text;
  bool named = true;
  bool curved = false;  ///< of second order
  const char* before = "";

  bool is(const char* other) const { return std::string_view(version) == other; }
};

class GmshMixedWriter {
 public:
  GmshMixedWriter(const MixedMesh& mesh, GmshDialect dialect)
      : mesh_(mesh), d_(dialect), out_(dialect.encoding) {}

  std::string write() {
    put_beginning();
    if (!v1_ && !v2_) put_entities();
    put_nodes();
    put_elements();
    return out_.content();
  }

 private:
  /// Gmsh's number of a shape and its nodes.
  struct Type {
    int number, nodes;
  };
  Type type_of(Shape shape) const {
    constexpr std::array<Type, 6> first{{{2, 3}, {3, 4}, {4, 4}, {7, 5}, {6, 6}, {5, 8}}},
        second{{{9, 6}, {16, 8}, {11, 10}, {19, 13}, {18, 15}, {17, 20}}};
    return (d_.curved ? second : first)[static_cast<std::size_t>(shape)];
  }
  static int tag_of(GlobalIndex point) { return 3 * static_cast<int>(point) + 5; }
  int middle_tag() const { return tag_of(std::ssize(mesh_.points)); }  ///< of all nodes that are no corners

  void put_beginning() {
    out_.text(d_.before);
    if (v1_) return;
    out_.text("$MeshFormat\n").text(d_.version).text(binary_ ? " 1 8\n" : " 0 8\n");
    if (binary_) out_.ints({1}).text("\n");
    out_.text("$EndMeshFormat\n");
    if (!d_.named) return;
    out_.text("$PhysicalNames\n7\n");
    for (int i = 0; i < 6; ++i)
      out_.text((d_.is("2.0") ? "" : "2 ") + std::to_string(i + 1) + " \"" +
                side_names[static_cast<std::size_t>(i)] + "\"\n");
    out_.text(d_.is("2.0") ? "9 \"air\"\n" : "3 9 \"air\"\n").text("$EndPhysicalNames\n");
  }

  void put_entities() {
    out_.text("$Entities\n").longs({1, 0, 6, 1});
    out_.ints({1}).reals({0, 0, 0});
    if (d_.is("4.0")) out_.reals({0, 0, 0});
    out_.longs({0});
    for (int i = 1; i <= 6; ++i)
      out_.ints({10 * i}).reals({0, 0, 0, 1, 1, 1}).longs({1}).ints({i}).longs({0});
    out_.ints({7}).reals({0, 0, 0, 2, 3, 1}).longs({1}).ints({9}).longs({1}).ints({10});
    out_.text("\n$EndEntities\n");
  }

  void put_place(std::size_t i) {
    const Vec3 place = i < mesh_.points.size() ? mesh_.points[i] : Vec3{0.5, 0.5, 0.5};
    if (binary_)
      out_.reals({place.x, place.y, place.z});
    else
      out_.text(decimal(place.x) + " " + decimal(place.y) + " " + decimal(place.z) + "\n");
  }

  void put_nodes() {
    const std::size_t count = mesh_.points.size() + (d_.curved ? 1 : 0);
    const auto n = static_cast<std::int64_t>(count);
    if (v1_ || v2_) {
      out_.text((v1_ ? "$NOD\n" : "$Nodes\n") + std::to_string(count) + "\n");
      for (std::size_t i = 0; i < count; ++i) {
        out_.ints({tag_of(static_cast<GlobalIndex>(i))});
        put_place(i);
      }
      out_.text(v1_ ? "$ENDNOD\n" : "$EndNodes\n");
      return;
    }
    out_.text("$Nodes\n").longs({1, n});
    if (d_.is("4.0")) {
      out_.ints({7, 3, 0}).longs({n});
      for (std::size_t i = 0; i < count; ++i) {
        out_.ints({tag_of(static_cast<GlobalIndex>(i))});
        put_place(i);
      }
    } else {
      out_.longs({5, 5 + 3 * n}).ints({3, 7, 0}).longs({n});
      for (std::size_t i = 0; i < count; ++i) out_.longs({tag_of(static_cast<GlobalIndex>(i))});
      for (std::size_t i = 0; i < count; ++i) put_place(i);
    }
    out_.text("\n$EndNodes\n");
  }

  template <class Put>
  void put_tags(const MixedElement& element, Put&& put) {
    for (const GlobalIndex corner : element.corners) put(tag_of(corner));
    for (int i = static_cast<int>(element.corners.size()); i < type_of(element.shape).nodes; ++i)
      put(middle_tag());
  }

  void put_element_v2(const MixedElement& element, int group, int entity) {
    const Type type = type_of(element.shape);
    if (binary_) out_.ints({type.number, 1, 2});
    out_.ints({++element_});
    if (v1_)
      out_.ints({type.number, group, entity, type.nodes});
    else if (!binary_)
      out_.ints({type.number, 2, group, entity});
    else
      out_.ints({group, entity});
    put_tags(element, [&](int tag) { out_.ints({tag}); });
    if (!binary_) out_.text("\n");
  }

  void put_block_v4(const std::vector<MixedElement>& elements, Shape shape, int dimension, int entity) {
    std::int64_t count = 0;
    for (const auto& element : elements) count += element.shape == shape;
    const bool v40 = d_.is("4.0");
    out_.ints({v40 ? entity : dimension, v40 ? dimension : entity, type_of(shape).number}).longs({count});
    for (const auto& element : elements) {
      if (element.shape != shape) continue;
      ++element_;
      v40 ? out_.ints({element_}) : out_.longs({element_});
      put_tags(element, [&](int tag) { v40 ? out_.ints({tag}) : out_.longs({tag}); });
    }
  }

  void put_elements() {
    std::int64_t count = std::ssize(mesh_.volumes);
    for (const auto& side : mesh_.sides) count += std::ssize(side);
    if (v1_ || v2_) {
      out_.text((v1_ ? "$ELM\n" : "$Elements\n") + std::to_string(count) + "\n");
      for (int i = 0; i < 6; ++i)
        for (const auto& element : mesh_.sides[static_cast<std::size_t>(i)])
          put_element_v2(element, i + 1, 10 * (i + 1));
      for (const auto& element : mesh_.volumes) put_element_v2(element, 9, 7);
      out_.text(v1_ ? "$ENDELM\n" : "$EndElements\n");
      return;
    }
    out_.text("$Elements\n").longs({6 * 2 + 4, count});
    if (!d_.is("4.0")) out_.longs({1, count});
    for (int i = 0; i < 6; ++i)
      for (const Shape shape : {Shape::triangle, Shape::quadrilateral})
        put_block_v4(mesh_.sides[static_cast<std::size_t>(i)], shape, 2, 10 * (i + 1));
    for (const Shape shape : {Shape::hexahedron, Shape::tetrahedron, Shape::pyramid, Shape::prism})
      put_block_v4(mesh_.volumes, shape, 3, 7);
    out_.text("\n$EndElements\n");
  }

  const MixedMesh& mesh_;
  GmshDialect d_;
  Writer out_;
  const bool binary_ = d_.encoding != Encoding::text, v1_ = d_.is("1"), v2_ = d_.version[0] == '2';
  int element_ = 0;
};

inline std::string gmsh_mixed(const MixedMesh& mesh, const GmshDialect& dialect) {
  return GmshMixedWriter(mesh, dialect).write();
}

struct Su2Dialect {
  const char* before = "";
  char exponent = '\0';
  const char* quote = "";
  const char* line_end = "\n";
  bool indices = true;
  bool points_first = false;
};

inline std::string su2_mixed(const MixedMesh& mesh, const Su2Dialect& dialect) {
  constexpr std::array<int, 6> types{5, 9, 10, 14, 13, 12};
  const auto elements = [&](const std::vector<MixedElement>& all) {
    std::string text;
    int index = 0;
    for (const auto& element : all) {
      text += std::to_string(types[static_cast<std::size_t>(element.shape)]);
      for (const GlobalIndex corner : element.corners) text += " " + std::to_string(corner);
      text += (dialect.indices ? " " + std::to_string(index++) : "") + "\n";
    }
    return text;
  };
  std::string points = "NPOIN= " + std::to_string(mesh.points.size()) + "\n";
  for (const Vec3& place : mesh.points)
    points += decimal(place.x, dialect.exponent) + "\t" + decimal(place.y, dialect.exponent) + " " +
              decimal(place.z, dialect.exponent) + "\n";
  const std::string volumes = "NELEM= " + std::to_string(mesh.volumes.size()) + "\n" + elements(mesh.volumes);
  std::string text =
      "NDIME= 3\n" + (dialect.points_first ? points + volumes : volumes + points) + "NMARK= 6\n";
  for (std::size_t i = 0; i < 6; ++i)
    text += std::string("MARKER_TAG= ") + dialect.quote + side_names[i] + dialect.quote +
            "\nMARKER_ELEMS= " + std::to_string(mesh.sides[i].size()) + "\n" + elements(mesh.sides[i]);
  std::string out = dialect.before;
  for (const char c : text) out += c == '\n' ? dialect.line_end : std::string(1, c);
  return out;
}

/// Surface ids are 1 to 6. In the file a pyramid is its base's first two corners, its apex, and the other two
/// (refine's picture: 0 1 4 3 go round the base).
inline std::string ugrid_mixed(const MixedMesh& mesh, const UgridForm& form) {
  Writer header(form.encoding), body(form.encoding);
  const auto sized = [](auto value) { return static_cast<std::int32_t>(value); };
  std::array<std::int32_t, 6> counts{};
  for (const auto& side : mesh.sides)
    for (const auto& element : side) ++counts[static_cast<std::size_t>(element.shape)];
  for (const auto& element : mesh.volumes) ++counts[static_cast<std::size_t>(element.shape)];
  const auto [tri, quad, tet, pyramid, prism, hex] = counts;
  header.ints({sized(mesh.points.size()), tri, quad, tet, pyramid, prism, hex});
  for (const Vec3& place : mesh.points)
    for (int d = 0; d < 3; ++d) {
      if (form.encoding == Encoding::text)
        body.text(decimal(place[d]) + " ");
      else if (form.single_reals)
        body.put(static_cast<float>(place[d]));
      else
        body.put(place[d]);
    }
  const auto put = [&](const std::vector<MixedElement>& elements, Shape shape) {
    for (const auto& element : elements) {
      if (element.shape != shape) continue;
      auto corners = element.corners;
      if (shape == Shape::pyramid) corners = {corners[1], corners[0], corners[4], corners[2], corners[3]};
      for (const GlobalIndex corner : corners) body.ints({sized(corner + 1)});
    }
  };
  for (const Shape shape : {Shape::triangle, Shape::quadrilateral})
    for (const auto& side : mesh.sides) put(side, shape);
  for (const Shape shape : {Shape::triangle, Shape::quadrilateral})
    for (int i = 0; i < 6; ++i)
      for (const auto& element : mesh.sides[static_cast<std::size_t>(i)])
        if (element.shape == shape) body.ints({i + 1});
  for (const Shape shape : {Shape::tetrahedron, Shape::pyramid, Shape::prism, Shape::hexahedron})
    put(mesh.volumes, shape);
  const auto record = [&](const std::string& content) {
    const std::string length = Writer(form.encoding).ints({sized(content.size())}).content();
    return form.fortran_records ? length + content + length : content;
  };
  return record(header.content()) + record(body.content());
}

/// Expects the box with its sides under `names`: conforming, of as many tetrahedra as its elements make, with
/// its volume and the areas of its sides. `tolerance` is relative.
inline void expect_box(const Mesh& mesh, const MixedMesh& mixed, const std::array<std::string, 6>& names,
                       Real tolerance = 1e-12) {
  ASSERT_NO_THROW(mesh.validate());
  EXPECT_EQ(mesh.points.size(), mixed.points.size());
  EXPECT_EQ(std::ssize(mesh.cells), mixed.tetrahedra());
  const auto at = [&](GlobalIndex point) { return mesh.points[static_cast<std::size_t>(point)]; };
  Real volume = 0;
  for (const auto& [a, b, c, d] : mesh.cells)
    volume += dot(cross(at(b) - at(a), at(c) - at(a)), at(d) - at(a)) / 6;
  EXPECT_NEAR(volume, MixedMesh::volume, tolerance * MixedMesh::volume);
  ASSERT_EQ(mesh.patches.size(), 6u);
  for (std::size_t side = 0; side < 6; ++side) {
    const auto patch = std::find_if(mesh.patches.begin(), mesh.patches.end(),
                                    [&](const Patch& p) { return p.name == names[side]; });
    ASSERT_NE(patch, mesh.patches.end()) << names[side];
    EXPECT_EQ(std::ssize(patch->triangles), mixed.triangles(side));
    Real area = 0;
    for (const auto& [a, b, c] : patch->triangles) area += norm(cross(at(b) - at(a), at(c) - at(a))) / 2;
    EXPECT_NEAR(area, MixedMesh::areas[side], tolerance * MixedMesh::areas[side]);
  }
}

}  // namespace alphadot::test
