// The first-order Jacobian as rows of 5 x 5 blocks in single precision.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "partition/subdomain.hpp"

namespace alphadot {

/// 5 x 5, column by column.
using Block = std::array<float, 25>;

/// One row a cell: the inverse of its diagonal block and one block for every neighbour, in the order of
/// Subdomain::cell_faces. 500 bytes a cell. Reading a few floats beyond a block is safe.
class BlockMatrix {
 public:
  explicit BlockMatrix(const Subdomain& domain);

  Block& inverse_diagonal(Index row) { return inverse_diagonal_[row]; }
  /// Blocks of a face: derivative of the left cell's residual with respect to the right state, and the other
  /// way round (absent where the right cell is a ghost).
  Block& right_of(Index face) { return blocks_[slot_[face][0]]; }
  Block& left_of(Index face) { return blocks_[slot_[face][1]]; }

  std::span<const Index> columns(Index row) const {
    return {columns_.data() + begin_[row], static_cast<std::size_t>(begin_[row + 1] - begin_[row])};
  }
  std::span<const Block> blocks(Index row) const {
    return {blocks_.data() + begin_[row], static_cast<std::size_t>(begin_[row + 1] - begin_[row])};
  }
  const Block& inverse_diagonal(Index row) const { return inverse_diagonal_[row]; }

  std::size_t bytes() const;

 private:
  std::vector<Index> begin_, columns_;
  std::vector<Block> blocks_, inverse_diagonal_;
  std::vector<std::array<Index, 2>>
      slot_;  // [faces] position in blocks_ seen from left and from right; -1: none
};

/// Inverse of a 5 x 5 matrix given and returned column by column.
std::array<Real, 25> inverse(const std::array<Real, 25>& matrix);

}  // namespace alphadot
