// The mesh of two tetrahedra that the tests of the readers write by hand, in every format.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/error.hpp"
#include "io/scanner.hpp"
#include "partition/mesh.hpp"

namespace alphadot::test {

// Tetrahedra 0 1 2 3 and 1 2 3 4. The free sides of the first are "wall", those of the second "far field".
inline constexpr std::array<std::array<double, 3>, 5> places{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};
inline constexpr std::array<std::array<int, 4>, 2> cells{{{0, 1, 2, 3}, {1, 2, 3, 4}}};
inline constexpr std::array<std::array<int, 3>, 6> triangles{
    {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 4}, {1, 3, 4}, {2, 3, 4}}};

/// Puts numbers one after another in any encoding, the counterpart of Scanner.
class Writer {
 public:
  explicit Writer(Encoding encoding) : encoding_(encoding) {}

  template <class T>
  Writer& put(T value) {
    if (encoding_ == Encoding::text) {
      content_ += std::to_string(value) + " ";
      return *this;
    }
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (encoding_ != native_encoding) std::reverse(bytes.begin(), bytes.end());
    content_.append(bytes.data(), bytes.size());
    return *this;
  }
  Writer& ints(std::initializer_list<std::int32_t> values) { return put_all(values); }
  Writer& longs(std::initializer_list<std::int64_t> values) { return put_all(values); }
  Writer& reals(std::initializer_list<double> values) { return put_all(values); }
  Writer& text(std::string_view text) {
    content_ += text;
    return *this;
  }
  const std::string& content() const { return content_; }

 private:
  template <class T>
  Writer& put_all(std::initializer_list<T> values) {
    for (const T value : values) put(value);
    return *this;
  }

  Encoding encoding_;
  std::string content_;
};

/// The header of a Gmsh file and the names of its physical groups.
inline void put_gmsh_beginning(Writer& writer, const char* version, Encoding encoding) {
  const bool binary = encoding != Encoding::text;
  writer.text("$MeshFormat\n").text(version).text(binary ? " 1 8\n" : " 0 8\n");
  if (binary) writer.ints({1}).text("\n");
  writer.text(
      "$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"wall\"\n2 2 \"far field\"\n3 3 "
      "\"fluid\"\n$EndPhysicalNames\n");
}

/// Nodes have the tags 10, 20, ... of their ids plus one when `sparse`.
inline std::string gmsh_22(Encoding encoding, bool sparse = false) {
  const int step = sparse ? 10 : 1;
  const bool binary = encoding != Encoding::text;
  Writer writer(encoding);
  put_gmsh_beginning(writer, "2.2", encoding);
  writer.text("$Nodes\n5\n");
  for (int i = 0; i < 5; ++i) {
    const auto [x, y, z] = places[static_cast<std::size_t>(i)];
    writer.ints({step * (i + 1)}).reals({x, y, z}).text(binary ? "" : "\n");
  }
  writer.text("$EndNodes\n$Elements\n9\n");
  int tag = 0;
  const auto put_start = [&](int type, int physical, int entity) {
    if (binary) writer.ints({type, 1, 2});
    writer.ints({++tag});
    if (!binary) writer.ints({type, 2});
    writer.ints({physical, entity});
  };
  const auto put_nodes = [&](const auto& points) {
    for (const int point : points) writer.ints({step * (point + 1)});
    writer.text(binary ? "" : "\n");
  };
  put_start(15, 0, 1);
  put_nodes(std::array{0});
  for (const auto& triangle : triangles) {
    const int patch = tag < 4 ? 1 : 2;
    put_start(2, patch, 10 * patch);
    put_nodes(triangle);
  }
  for (const auto& cell : cells) {
    put_start(4, 3, 1);
    put_nodes(cell);
  }
  writer.text("$EndElements\n");
  return writer.content();
}

inline std::string gmsh_41(Encoding encoding, bool sparse = false) {
  const std::int64_t step = sparse ? 10 : 1;
  Writer writer(encoding);
  put_gmsh_beginning(writer, "4.1", encoding);
  writer.text("$Entities\n").longs({1, 1, 2, 1});
  writer.ints({1}).reals({0, 0, 0}).longs({0});
  writer.ints({1}).reals({0, 0, 0, 1, 0, 0}).longs({0, 2}).ints({1, -1});
  writer.ints({10}).reals({0, 0, 0, 1, 1, 1}).longs({2}).ints({7, 1}).longs({1}).ints({1});  // group 7 has no
                                                                                             // name
  writer.ints({20}).reals({0, 0, 0, 1, 1, 1}).longs({1}).ints({-2}).longs({0});              // reversed
  writer.ints({1}).reals({0, 0, 0, 1, 1, 1}).longs({1}).ints({3}).longs({2}).ints({10, 20});
  writer.text("\n$EndEntities\n$Nodes\n").longs({2, 5, step, 5 * step});
  writer.ints({2, 10, 0}).longs({4, step, 2 * step, 3 * step, 4 * step});
  for (std::size_t i = 0; i < 4; ++i) writer.reals({places[i][0], places[i][1], places[i][2]});
  writer.ints({2, 20, 1}).longs({1, 5 * step}).reals({1, 1, 1, 0.5, 0.5});  // parametric: u and v
  writer.text("\n$EndNodes\n$Elements\n").longs({4, 9, 1, 9});
  std::int64_t tag = 0;
  const auto put_element = [&](const auto& points) {
    writer.longs({++tag});
    for (const int point : points) writer.longs({step * (point + 1)});
  };
  writer.ints({0, 1, 15}).longs({1});
  put_element(std::array{0});
  for (const int patch : {0, 1}) {
    writer.ints({2, 10 * (patch + 1), 2}).longs({3});
    for (int i = 0; i < 3; ++i) put_element(triangles[static_cast<std::size_t>(3 * patch + i)]);
  }
  writer.ints({3, 1, 4}).longs({2});
  for (const auto& cell : cells) put_element(cell);
  writer.text("\n$EndElements\n");
  return writer.content();
}

inline std::string su2() {
  return "% two tetrahedra\n"
         "NDIME= 3\n"
         "NELEM= 2\n"
         "10 0 1 2 3 0\n"
         "10 1 2 3 4 1\n"
         "NPOIN= 5\n"
         "0 0 0 0\n"
         "1 0 0 1\n"
         "0 1 0 2\n"
         "0 0 1 3\n"
         "1 1 1 4\n"
         "NMARK= 2\n"
         "MARKER_TAG= wall\n"
         "MARKER_ELEMS= 3\n"
         "5 0 1 2\n"
         "5 0 1 3\n"
         "5 0 2 3\n"
         "MARKER_TAG= far_field\n"
         "MARKER_ELEMS= 3\n"
         "5 1 2 4\n"
         "5 1 3 4\n"
         "5 2 3 4\n";
}

/// Surfaces 1 and 2 are the wall and the far field.
inline std::string ugrid(Encoding encoding) {
  Writer writer(encoding);
  writer.ints({5, 6, 0, 2, 0, 0, 0});
  for (const auto& [x, y, z] : places) writer.reals({x, y, z});
  for (const auto& [a, b, c] : triangles) writer.ints({a + 1, b + 1, c + 1});
  writer.ints({1, 1, 1, 2, 2, 2});
  for (const auto& [a, b, c, d] : cells) writer.ints({a + 1, b + 1, c + 1, d + 1});
  return writer.content();
}

/// Expects the two tetrahedra with the free sides under these names.
inline void expect_two_cells(const Mesh& mesh, const std::string& wall, const std::string& far_field) {
  ASSERT_EQ(mesh.points.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.points[i][k], places[i][static_cast<std::size_t>(k)]);
  ASSERT_EQ(mesh.cells.size(), cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_TRUE(std::equal(cells[i].begin(), cells[i].end(), mesh.cells[i].begin()));
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.patches[0].name, wall);
  EXPECT_EQ(mesh.patches[1].name, far_field);
  for (std::size_t patch = 0; patch < 2; ++patch) {
    ASSERT_EQ(mesh.patches[patch].triangles.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(std::equal(triangles[3 * patch + i].begin(), triangles[3 * patch + i].end(),
                             mesh.patches[patch].triangles[i].begin()));
  }
  EXPECT_NO_THROW(mesh.validate());
}

/// `text` with its first `from` replaced by `to`.
inline std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos) {
    ADD_FAILURE() << "no '" << from << "' to replace";
    return text;
  }
  return text.replace(place, from.size(), to);
}

/// The message of the InputError that `work` throws; empty when it throws none.
template <class Work>
std::string error_of(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Expects `text` to hold every one of `parts`.
inline void expect_parts(const std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in '" << text << "'";
}

}  // namespace alphadot::test
