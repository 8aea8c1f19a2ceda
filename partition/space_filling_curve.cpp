#include "partition/space_filling_curve.hpp"

#include <algorithm>
#include <array>

namespace alphadot {

std::uint64_t hilbert_position(const Vec3& at, const Box& box) {
  constexpr int bits = 21;
  std::array<std::uint32_t, 3> x{};
  for (int axis = 0; axis < 3; ++axis) {
    const Real width = box.upper[axis] - box.lower[axis];
    const Real share = width > 0 ? std::clamp((at[axis] - box.lower[axis]) / width, Real{0}, Real{1}) : 0;
    x[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(share * ((1U << bits) - 1));
  }
  // From coordinates to the transposed position: undo the reflections and rotations of every level, from the
  // coarsest on, then Gray decode.
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1) {
    const std::uint32_t below = level - 1;
    for (auto& coordinate : x) {
      if (coordinate & level) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ coordinate) & below;
        x[0] ^= swapped;
        coordinate ^= swapped;
      }
    }
  }
  for (std::size_t axis = 1; axis < 3; ++axis) x[axis] ^= x[axis - 1];
  std::uint32_t flips = 0;
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1)
    if (x[2] & level) flips ^= level - 1;
  std::uint64_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::uint32_t coordinate : x) position = position << 1 | ((coordinate ^ flips) >> bit & 1);
  return position;
}

}  // namespace alphadot
