// What a reader owes for any input: a mesh whose ids are in range, or an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.hpp"
#include "fuzz/largest_allocation.hpp"
#include "partition/mesh.hpp"

namespace alphadot::fuzz {

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Hexahedra, 32 bytes in a file, make twelve tetrahedra of 32 bytes each at most.
inline constexpr std::size_t share_of_cut_elements = 12;

/// Ends the program when an id of the mesh that `read` gives is out of range, or when a block of memory is
/// out of proportion to the `size` of the file.
template <class Read>
void check_mesh(std::size_t size, Read&& read) {
  const LargestAllocation limit(size, share_of_cut_elements);
  try {
    const Mesh mesh = read();
    const auto check = [&](const auto& ids) {
      for (const GlobalIndex id : ids)
        if (id < 0 || id >= static_cast<GlobalIndex>(mesh.points.size())) std::abort();
    };
    for (const auto& cell : mesh.cells) check(cell);
    for (const Patch& patch : mesh.patches)
      for (const auto& triangle : patch.triangles) check(triangle);
  } catch (const InputError&) {
    // Refusing is as good.
  }
}

}  // namespace alphadot::fuzz
