// The meshes of the corpus: every mix of elements, each a box of known volume and areas, cut into cubes,
// whose elements are numbered at random and partly left-handed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "io/readers/mesh_writers.hpp"
#include "support/mixed_mesh.hpp"

namespace alphadot::test {

using testing_support::Column;
using testing_support::mixed_mesh;
using testing_support::MixedMeshSettings;

struct Mix {
  const char* name;
  MixedMeshSettings settings;
};

inline std::vector<Mix> mixes() {
  const auto all = {Column::hexahedra, Column::prisms, Column::middles};
  return {
      {"hexahedra", {.columns = {Column::hexahedra}}},
      {"prisms", {.columns = {Column::prisms}}},
      {"pyramids", {.columns = {Column::middles}, .triangle_percent = 0}},
      {"tetrahedra", {.columns = {Column::middles}, .triangle_percent = 100}},
      {"tetrahedra and pyramids", {.columns = {Column::middles}}},
      {"hexahedra and prisms", {.cubes = {3, 3, 2}, .columns = {Column::hexahedra, Column::prisms}}},
      {"hexahedra, pyramids, tetrahedra",
       {.cubes = {3, 3, 2}, .columns = {Column::hexahedra, Column::middles}}},
      {"prisms, pyramids, tetrahedra", {.cubes = {3, 3, 2}, .columns = {Column::prisms, Column::middles}}},
      {"all", {.cubes = {4, 4, 3}, .columns = all}}};
}

using Names = std::array<std::string, 6>;

inline Names given_names() {
  Names names;
  std::copy(side_names.begin(), side_names.end(), names.begin());
  return names;
}
inline Names numbered(const std::string& prefix) {
  Names names;
  for (std::size_t i = 0; i < 6; ++i) names[i] = prefix + std::to_string(i + 1);
  return names;
}

/// Calls act(mesh, description) for every mix, three meshes of each.
template <class Act>
int for_each_mesh(Act&& act) {
  int count = 0;
  for (const Mix& mix : mixes())
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      MixedMeshSettings settings = mix.settings;
      settings.seed = seed;
      SCOPED_TRACE(testing::Message() << mix.name << ", seed " << seed);
      act(mixed_mesh(settings));
      ++count;
      if (testing::Test::HasFailure()) return count;  // one is enough to read
    }
  return count;
}

}  // namespace alphadot::test
