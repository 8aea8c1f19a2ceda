// The first-order Jacobian as rows of 5 x 5 blocks in single precision.
#pragma once

#include <array>
#include <experimental/simd>
#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "core/prefetch.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// 5 x 5, column by column.
using Block = std::array<float, 25>;

/// Five numbers in a vector register; the last three lanes are without meaning.
using Lanes = std::experimental::fixed_size_simd<float, 8>;

/// y + A x, column by column. A column is loaded with the three numbers behind it, which land in unused
/// lanes.
inline Lanes multiply_add(Lanes y, const Block& a, const float* x) {
  for (std::size_t column = 0; column < 5; ++column)
    y += Lanes(&a[5 * column], std::experimental::element_aligned) * Lanes(x[column]);
  return y;
}

/// One row a cell: the inverse of its diagonal block and four blocks for the neighbours across its faces, in
/// the order of Subdomain::cell_faces. Faces of the boundary leave a block of zeros at the end of the row,
/// whose column is the row itself. 500 bytes a cell. Reading a few floats beyond a block is safe.
class BlockMatrix {
 public:
  static constexpr std::size_t neighbours = 4;
  using Columns = std::array<Index, neighbours>;
  using Blocks = std::array<Block, neighbours>;

  explicit BlockMatrix(const Subdomain& domain);

  Block& inverse_diagonal(Index row) { return inverse_diagonal_[static_cast<std::size_t>(row)]; }
  /// Blocks of a face: derivative of the left cell's residual with respect to the right state, and the other
  /// way round (absent where the right cell is a ghost).
  Block& right_of(Index face) { return at(slots_[static_cast<std::size_t>(face)][0]); }
  Block& left_of(Index face) { return at(slots_[static_cast<std::size_t>(face)][1]); }

  const Columns& columns(Index row) const { return columns_[static_cast<std::size_t>(row)]; }
  const Blocks& blocks(Index row) const { return blocks_[static_cast<std::size_t>(row)]; }
  const Block& inverse_diagonal(Index row) const { return inverse_diagonal_[static_cast<std::size_t>(row)]; }

  /// Asks the memory for a row, some rows before it is needed; rows that are not there are passed over.
  void prefetch(Index row) const {
    if (row < 0 || row >= static_cast<Index>(columns_.size())) return;
    alphadot::prefetch(blocks(row));
  }

  /// Multiplies the neighbours' blocks of every row by its inverse diagonal block, so that a relaxation of
  /// the row needs no further product.
  void scale_rows();

  /// Makes it its own transpose, in place: row i then has (D_j^-1 O_ji)^T for its neighbour j, of a matrix
  /// whose rows have been scaled, and the transpose of its own inverse diagonal block. Twice is not at all.
  /// The blocks of neighbours on other ranks come from there. Collective.
  void transpose(const Subdomain& domain, const Communicator& comm);

  std::size_t bytes() const;

 private:
  struct Slot {
    Index row = -1;
    Index neighbour = -1;
  };
  Block& at(Slot slot) {
    return blocks_[static_cast<std::size_t>(slot.row)][static_cast<std::size_t>(slot.neighbour)];
  }

  /// Puts into the rows along cuts the transposes of what the rows on the other side hold for them.
  void transpose_cut_faces(const Subdomain& domain, const Communicator& comm);

  std::vector<Columns> columns_;
  std::vector<Blocks> blocks_;              // one row more than there are
  std::vector<Block> inverse_diagonal_;     // one more than there are rows
  std::vector<std::array<Slot, 2>> slots_;  // [faces] seen from left and from right
};

/// Inverse of a 5 x 5 matrix given and returned column by column.
std::array<Real, 25> inverse(const std::array<Real, 25>& matrix);

}  // namespace alphadot
